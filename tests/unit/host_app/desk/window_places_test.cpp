#include <gtest/gtest.h>

#include "host_app/desk/windows/gl_window.h"

namespace vantage {
namespace {

const WindowPlace first{0, 0, 1920, 1080}, second{1920, 0, 1024, 768}, third{-800, 0, 800, 600};

TEST(PlaceForRigs, IsTheWholeSecondMonitor) {
    EXPECT_EQ(place_for_rigs(std::vector{first, second, third}, {}), second);
}

TEST(PlaceForRigs, IsNeverAMonitorThatTheProgrammeFills) {
    const std::vector<int> on_second{2}, on_both{2, 3}, everywhere{1, 2};
    EXPECT_EQ(place_for_rigs(std::vector{first, second, third}, on_second), third);
    EXPECT_EQ(place_for_rigs(std::vector{first, second, third}, on_both),
              (WindowPlace{960, 540, 960, 540}))
        << "a corner of the operator's";
    EXPECT_FALSE(place_for_rigs(std::vector{first, second}, everywhere));
    EXPECT_FALSE(place_for_rigs({}, {})) << "no monitor is there";
}

TEST(WindowPlace, CoversTheProgrammeIfPartOfItIsOnItsMonitor) {
    const std::vector monitors{first, second};
    const std::vector<int> filled{2};
    EXPECT_TRUE(covers_programme(second, monitors, filled));
    EXPECT_TRUE(covers_programme({1500, 100, 600, 400}, monitors, filled));
    EXPECT_FALSE(covers_programme({1300, 100, 640, 400}, monitors, filled)) << "only its rim";
    EXPECT_FALSE(covers_programme(second, monitors, std::vector{3})) << "which is gone";
}

}  // namespace
}  // namespace vantage
