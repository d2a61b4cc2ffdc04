#include "common/base/time/clock_step_watch.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr MonotonicTime watch_start = MonotonicTime(100s);
constexpr TaiTime watch_tai = TaiTime(1'795'219'200s);

TEST(ClockStepWatch, NamesAStepEitherWayOnce) {
    ClockStepWatch watch;
    EXPECT_FALSE(watch.observe(watch_start, watch_tai));
    EXPECT_FALSE(watch.observe(watch_start + 1s, watch_tai + 1s));
    EXPECT_EQ(watch.observe(watch_start + 2s, watch_tai + 1h + 2s), 1h);
    EXPECT_FALSE(watch.observe(watch_start + 3s, watch_tai + 1h + 3s)) << "it is told once";
    EXPECT_EQ(watch.observe(watch_start + 4s, watch_tai + 4s), -1h);
    EXPECT_EQ(watch.steps(), 2u);
    EXPECT_EQ(watch.last_step(), -1h);
}

TEST(ClockStepWatch, ATrimmedClockIsNotSet) {
    ClockStepWatch watch;
    EXPECT_FALSE(watch.observe(watch_start, watch_tai));
    // 500 ppm over ten minutes, looked at once.
    EXPECT_FALSE(watch.observe(watch_start + 600s, watch_tai + 600s + 300ms));
    EXPECT_EQ(watch.steps(), 0u);
}

TEST(SleepUntil, ReturnsAtTheDeadlineOfTheStagesClock) {
    const TaiTime deadline = TaiClock::now() + 20ms;
    sleep_until(deadline);
    EXPECT_GE(TaiClock::now(), deadline);
}

}  // namespace
}  // namespace vantage
