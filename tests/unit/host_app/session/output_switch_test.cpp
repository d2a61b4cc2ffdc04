#include "host_app/session/output_switch.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

class OutputSwitchTest : public testing::Test {
  protected:
    OutputSwitchTest()
        : desk_({.format = {.width_px = 64, .height_px = 48, .encoder = "libx264"},
                 .urls = {"udp://127.0.0.1:5998", "udp://127.0.0.1:5999"}}),
          switch_(desk_) {}
    OutputSupervisor desk_;
    OutputSwitch switch_;
    const MonotonicTime now_ = MonotonicClock::now();
};

TEST_F(OutputSwitchTest, AsksBeforeItStopsAnOutput) {
    switch_.press(2, now_);
    EXPECT_TRUE(desk_.is_wanted(1));
    EXPECT_EQ(switch_.question(now_), "Press F6 again to stop udp://127.0.0.1:5999");
    switch_.press(2, now_ + 1s);
    EXPECT_FALSE(desk_.is_wanted(1));
    EXPECT_TRUE(desk_.is_wanted(0));
    EXPECT_EQ(switch_.question(now_ + 1s), "");
}

TEST_F(OutputSwitchTest, StartsAnOutputAtOnce) {
    desk_.stop(0);
    switch_.press(1, now_);
    EXPECT_TRUE(desk_.is_wanted(0));
    EXPECT_EQ(switch_.question(now_), "");
}

TEST_F(OutputSwitchTest, ForgetsAPressAfterThreeSecondsOrAnotherKey) {
    switch_.press(1, now_);
    EXPECT_EQ(switch_.question(now_ + 4s), "");
    switch_.press(1, now_ + 4s);
    EXPECT_TRUE(desk_.is_wanted(0)) << "it is asked anew";
    switch_.press(2, now_ + 5s);
    switch_.press(1, now_ + 6s);
    EXPECT_TRUE(desk_.is_wanted(0));
    EXPECT_TRUE(desk_.is_wanted(1));
}

TEST_F(OutputSwitchTest, ReportsAnOutputThatDoesNotExist) {
    for (const int number : {0, -1, 8, 3}) switch_.press(number, now_);
    EXPECT_EQ(switch_.question(now_), "There is no output 3; add it with --output");
    EXPECT_EQ(switch_.question(now_ + 4s), "");
}

}  // namespace
}  // namespace vantage
