#include "host_app/desk/windows/screen_windows.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "common/image/image_file.h"
#include "tests/support/virtual_screen.h"

namespace vantage {
namespace {

constexpr int screen_width_px = 640, screen_height_px = 480;

class ScreenWindowsTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!VirtualScreen::is_there()) GTEST_SKIP() << "SKIPPED: Xvfb or xdotool is not installed";
        if (!std::filesystem::exists("/usr/bin/ffmpeg"))
            GTEST_SKIP() << "SKIPPED: ffmpeg is not installed";
        screen_.emplace(screen_width_px, screen_height_px);
        setenv("DISPLAY", screen_->display().c_str(), 1);
        unsetenv("WAYLAND_DISPLAY");
    }

    /// Reads a pixel from the X server.
    cv::Vec4b pixel_at(int x, int y) const {
        const std::string file = (folder_.path() / "shot.png").string();
        const ProgramResult shot =
            run_to_end("/usr/bin/ffmpeg",
                       {"-v", "error", "-y", "-f", "x11grab", "-draw_mouse", "0", "-video_size",
                        fmt::format("{}x{}", screen_width_px, screen_height_px), "-i",
                        screen_->display(), "-frames:v", "1", file});
        EXPECT_EQ(shot.status, 0) << shot.err;
        return read_colour_image(file)(y, x);
    }

    TemporaryFolder folder_;
    std::optional<VirtualScreen> screen_;
    std::shared_ptr<ScreenFeed> feed_ = std::make_shared<ScreenFeed>(1);
};

TEST_F(ScreenWindowsTest, FillsTheMonitorInTheShapeOfThePicture) {
    ScreenWindows windows(false);
    const std::vector feeds{feed_};
    windows.follow(feeds);
    EXPECT_EQ(feed_->state(), ScreenFeed::State::closed) << "nobody asked";
    feed_->ask();
    windows.follow(feeds);
    ASSERT_EQ(feed_->state(), ScreenFeed::State::shown) << feed_->failure();
    EXPECT_EQ(windows.monitors(), std::vector{1});
    // 16:9 on 4:3: 360 rows of 480.
    ColourImage picture(90, 160, cv::Vec4b(200, 40, 40, 255));
    picture.rowRange(45, 90) = cv::Vec4b(30, 60, 220, 255);
    feed_->put(picture);
    windows.follow(feeds);
    EXPECT_EQ(pixel_at(320, 100), cv::Vec4b(200, 40, 40, 255)) << "its top is at the top";
    EXPECT_EQ(pixel_at(320, 400), cv::Vec4b(30, 60, 220, 255));
    EXPECT_EQ(pixel_at(2, 400), cv::Vec4b(30, 60, 220, 255)) << "from edge to edge";
    EXPECT_EQ(pixel_at(320, 20), cv::Vec4b(0, 0, 0, 255));
    EXPECT_EQ(pixel_at(320, 460), cv::Vec4b(0, 0, 0, 255));
    feed_->close();
    windows.follow(feeds);
    EXPECT_EQ(pixel_at(320, 100), cv::Vec4b(0, 0, 0, 255)) << "the window is gone";
}

TEST_F(ScreenWindowsTest, ReportsThatItsMonitorIsGoneAndOpensAgain) {
    ScreenWindows windows(false);
    const std::vector feeds{feed_};
    feed_->ask();
    windows.follow(feeds);
    ASSERT_EQ(feed_->state(), ScreenFeed::State::shown) << feed_->failure();
    // GLFW turns the windows of an unplugged monitor into ordinary ones.
    glfwSetWindowMonitor(glfwGetCurrentContext(), nullptr, 0, 0, 64, 48, GLFW_DONT_CARE);
    windows.follow(feeds);
    EXPECT_EQ(feed_->state(), ScreenFeed::State::failed);
    EXPECT_TRUE(windows.monitors().empty());
    EXPECT_EQ(glfwGetCurrentContext(), nullptr) << "the context of the closed window is gone";
    EXPECT_NE(feed_->failure().find("monitor 1 is gone"), std::string::npos) << feed_->failure();
    feed_->ask();
    windows.follow(feeds);
    EXPECT_EQ(feed_->state(), ScreenFeed::State::shown) << feed_->failure();
}

TEST_F(ScreenWindowsTest, WorksBesideTheOperatorsWindow) {
    OperatorWindow window("Vantage", 320, 240);
    ScreenWindows windows(true);
    const std::vector feeds{feed_};
    feed_->ask();
    windows.follow(feeds);
    ASSERT_EQ(feed_->state(), ScreenFeed::State::shown) << feed_->failure();
    feed_->put(ColourImage(48, 64, cv::Vec4b(20, 160, 80, 255)));
    windows.follow(feeds);
    // The operator's context is current again.
    window.poll(0);
    window.show(DeskState());
    EXPECT_FALSE(window.screenshot().empty());
}

TEST_F(ScreenWindowsTest, ReportsAMonitorThatDoesNotExist) {
    const auto far = std::make_shared<ScreenFeed>(7);
    ScreenWindows windows(false);
    far->ask();
    windows.follow(std::vector{far});
    EXPECT_EQ(far->state(), ScreenFeed::State::failed);
    EXPECT_EQ(far->failure(), "there is no monitor 7: this display has 1");
}

TEST(ScreenWindowsWithoutADisplay, ReportTheReasonToTheFeed) {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    const auto feed = std::make_shared<ScreenFeed>(1);
    ScreenWindows windows(false);
    feed->ask();
    windows.follow(std::vector{feed});
    EXPECT_EQ(feed->state(), ScreenFeed::State::failed);
    EXPECT_NE(feed->failure().find("cannot open a window"), std::string::npos) << feed->failure();
}

}  // namespace
}  // namespace vantage
