#include "common/base/time/clock_step_watch.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr MonotonicTime start = MonotonicTime(100s);
constexpr TaiTime tai = TaiTime(1'795'219'200s);

TEST(ClockStepWatch, NamesAStepEitherWayOnce) {
    ClockStepWatch watch;
    EXPECT_FALSE(watch.observe(start, tai));
    EXPECT_FALSE(watch.observe(start + 1s, tai + 1s));
    EXPECT_EQ(watch.observe(start + 2s, tai + 1h + 2s), 1h);
    EXPECT_FALSE(watch.observe(start + 3s, tai + 1h + 3s)) << "it is told once";
    EXPECT_EQ(watch.observe(start + 4s, tai + 4s), -1h);
    EXPECT_EQ(watch.steps(), 2u);
    EXPECT_EQ(watch.last_step(), -1h);
}

TEST(ClockStepWatch, ATrimmedClockIsNotSet) {
    ClockStepWatch watch;
    EXPECT_FALSE(watch.observe(start, tai));
    // 500 ppm over ten minutes, looked at once.
    EXPECT_FALSE(watch.observe(start + 600s, tai + 600s + 300ms));
    EXPECT_EQ(watch.steps(), 0u);
}

TEST(SleepUntil, ReturnsAtTheDeadlineOfTheStagesClock) {
    const TaiTime deadline = TaiClock::now() + 20ms;
    sleep_until(deadline);
    EXPECT_GE(TaiClock::now(), deadline);
}

}  // namespace
}  // namespace vantage
