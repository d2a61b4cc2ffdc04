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

/// The desk as a person has looked at it. Where it is to look otherwise, VANTAGE_WRITE_PICTURES in
/// the environment writes the pictures anew, for another look.
class DeskPictures : public testing::TestWithParam<cv::Size> {
  protected:
    void SetUp() override {
        if (!VirtualScreen::is_there()) GTEST_SKIP() << "SKIPPED: Xvfb or xdotool is not installed";
    }
    static void expect_as_looked_at(const std::string& name, void (*change)(ExampleDesk&) = nullptr,
                                    const DeskSwitches& switches = {});
};

void DeskPictures::expect_as_looked_at(const std::string& name, void (*change)(ExampleDesk&),
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
    const std::filesystem::path file = source_folder() / "tests/unit/window/pictures" /
                                       fmt::format("{}_{}x{}.png", name, size.width, size.height);
    if (std::getenv("VANTAGE_WRITE_PICTURES")) write_colour_image(file, shown);
    const ColourImage expected = read_colour_image(file);
    ASSERT_EQ(expected.size(), size);
    // Drivers and versions of fonts differ by shades at the edges of letters and lines.
    constexpr int visible = 60;
    constexpr double most_differing = 0.01;
    ColourImage difference;
    cv::absdiff(shown, expected, difference);
    const auto differing =
        std::count_if(difference.begin(), difference.end(),
                      [](const cv::Vec4b& d) { return d[0] + d[1] + d[2] > visible; });
    EXPECT_LT(static_cast<double>(differing), most_differing * size.area());
}

TEST_P(DeskPictures, AreThoseThatWereLookedAt) { expect_as_looked_at("desk"); }

TEST_P(DeskPictures, OfAWheelsMapAreThoseThatWereLookedAt) {
    expect_as_looked_at("jog", [](ExampleDesk& desk) { desk.open_wheel_map(); });
}

/// As large as displays are.
class DeskLargePictures : public DeskPictures {};

TEST_P(DeskLargePictures, AreThoseThatWereLookedAt) { expect_as_looked_at("desk"); }

/// States in which the desk is laid out as in another one, but for a part.
class DeskStatePictures : public DeskPictures {};

TEST_P(DeskStatePictures, OfAPreviewAreThoseThatWereLookedAt) {
    expect_as_looked_at("preview", [](ExampleDesk& desk) { desk.show_preview(); });
}

TEST_P(DeskStatePictures, OfTheFiguresAreThoseThatWereLookedAt) {
    expect_as_looked_at("figures", nullptr, {.figures = true});
}

TEST_P(DeskStatePictures, OfTheStageFromOutsideAreThoseThatWereLookedAt) {
    expect_as_looked_at("outside", [](ExampleDesk& desk) { desk.add_points(); }, {.outside = true});
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
