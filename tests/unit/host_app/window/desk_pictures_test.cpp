#include <algorithm>
#include <cstdlib>
#include <optional>

#include <gtest/gtest.h>

#include "common/image/image_file.h"
#include "host_app/desk/windows/operator_window.h"
#include "tests/support/source_folder.h"
#include "tests/support/virtual_screen.h"
#include "tests/unit/host_app/desk/example_desk.h"

namespace vantage {
namespace {

/// Compares the desk with reviewed pictures. After an intended change, run the test with
/// VANTAGE_WRITE_PICTURES in the environment to write new pictures, and review them.
class DeskPictures : public testing::TestWithParam<cv::Size> {
  protected:
    void SetUp() override {
        if (!VirtualScreen::is_there()) GTEST_SKIP() << "SKIPPED: Xvfb or xdotool is not installed";
    }
    static void expect_as_reviewed(const std::string& name, void (*change)(ExampleDesk&) = nullptr,
                                   const DeskSwitches& switches = {});
};

void DeskPictures::expect_as_reviewed(const std::string& name, void (*change)(ExampleDesk&),
                                      const DeskSwitches& switches) {
    const cv::Size size = GetParam();
    const VirtualScreen screen(size.width, size.height);
    setenv("DISPLAY", screen.display().c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    OperatorWindow window("Vantage", size.width, size.height);
    ExampleDesk desk;
    if (change) change(desk);
    window.arrange({switches});
    window.show(desk.state);
    const ColourImage shown = window.screenshot();
    ASSERT_EQ(shown.size(), size);
    const std::filesystem::path file = source_folder() / "tests/unit/host_app/window/pictures" /
                                       fmt::format("{}_{}x{}.png", name, size.width, size.height);
    if (std::getenv("VANTAGE_WRITE_PICTURES")) write_colour_image(file, shown);
    const ColourImage expected = read_colour_image(file);
    ASSERT_EQ(expected.size(), size);
    // Drivers and font versions differ slightly at the edges of letters and lines.
    constexpr int visible = 60;
    constexpr double max_differing_share = 0.01;
    ColourImage difference;
    cv::absdiff(shown, expected, difference);
    const auto differing =
        std::count_if(difference.begin(), difference.end(),
                      [](const cv::Vec4b& d) { return d[0] + d[1] + d[2] > visible; });
    EXPECT_LT(static_cast<double>(differing), max_differing_share * size.area());
}

TEST_P(DeskPictures, MatchTheReviewedOnes) { expect_as_reviewed("desk"); }

TEST_P(DeskPictures, OfAWheelMapMatchTheReviewedOnes) {
    expect_as_reviewed("jog", [](ExampleDesk& desk) { desk.open_wheel_map(); });
}

/// The largest usual display.
class DeskLargePictures : public DeskPictures {};

TEST_P(DeskLargePictures, MatchTheReviewedOnes) { expect_as_reviewed("desk"); }

/// States that change only a part of the desk.
class DeskStatePictures : public DeskPictures {};

TEST_P(DeskStatePictures, OfAPreviewMatchTheReviewedOnes) {
    expect_as_reviewed("preview", [](ExampleDesk& desk) { desk.show_preview(); });
}

TEST_P(DeskStatePictures, OfTheFiguresMatchTheReviewedOnes) {
    expect_as_reviewed("figures", nullptr, {.figures = true});
}

TEST_P(DeskStatePictures, OfTheStageFromOutsideMatchTheReviewedOnes) {
    expect_as_reviewed("outside", [](ExampleDesk& desk) { desk.add_points(); }, {.outside = true});
}

std::string name_of_size(const testing::TestParamInfo<cv::Size>& size) {
    return fmt::format("{}x{}", size.param.width, size.param.height);
}
INSTANTIATE_TEST_SUITE_P(Sizes, DeskPictures,
                         testing::Values(cv::Size(640, 360), cv::Size(1280, 720),
                                         cv::Size(1920, 1080)),
                         name_of_size);
INSTANTIATE_TEST_SUITE_P(Sizes, DeskLargePictures, testing::Values(cv::Size(3840, 2160)),
                         name_of_size);
INSTANTIATE_TEST_SUITE_P(Sizes, DeskStatePictures,
                         testing::Values(cv::Size(640, 360), cv::Size(1280, 720)), name_of_size);

}  // namespace
}  // namespace vantage
