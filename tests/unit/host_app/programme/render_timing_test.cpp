#include "host_app/programme/stats/render_timing.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// Timing of a programme with 25 fps, a period of 40 ms.
RenderTiming timing_of(int frames, double make_ms) {
    RenderTiming timing(25, MonotonicTime{1h});
    for (int i = 0; i < frames; ++i) timing.add(make_ms);
    return timing;
}

TEST(RenderTiming, StartsAWholePeriodAheadUntilItHasSamples) {
    const RenderTiming timing = timing_of(5, 10);
    EXPECT_EQ(timing.usual_ms(), 0);
    EXPECT_FALSE(timing.are_frames_long());
    EXPECT_EQ(timing.lead(true, 1ms), 40ms);
}

TEST(RenderTiming, StartsEarlyEnoughForTheLongestFrame) {
    RenderTiming timing = timing_of(40, 10);
    timing.add(20);
    EXPECT_EQ(timing.usual_ms(), 10);
    EXPECT_NEAR(to_ms(timing.lead(true, 1ms)), 1.3 * 20 + 3, 1e-6);
    for (int i = 0; i < 200; ++i) timing.add(10);
    EXPECT_NEAR(to_ms(timing.lead(true, 1ms)), 1.3 * 10 + 3, 1e-6) << "old frames are forgotten";
}

TEST(RenderTiming, LeavesFramesLongerThanATickToReprojection) {
    const RenderTiming timing = timing_of(40, 60);
    EXPECT_TRUE(timing.are_frames_long());
    EXPECT_EQ(timing.lead(true, 5ms), 5ms);
    EXPECT_EQ(timing.lead(false, 5ms), 40ms) << "without depth it starts as early as possible";
}

TEST(RenderTiming, SpendsItsBudgetAndEarnsItBack) {
    RenderTiming timing = timing_of(1, 40);
    EXPECT_FALSE(timing.has_budget(0.75, MonotonicTime{1h} + 40ms)) << "30 of 40 ms are available";
    EXPECT_TRUE(timing.has_budget(0.75, MonotonicTime{1h} + 60ms));
}

TEST(RenderTiming, EarnsASmallerBudgetMoreSlowly) {
    RenderTiming timing = timing_of(1, 40);
    EXPECT_FALSE(timing.has_budget(0.25, MonotonicTime{1h} + 60ms)) << "15 of 40 ms are available";
    EXPECT_TRUE(timing.has_budget(0.25, MonotonicTime{1h} + 200ms));
}

}  // namespace
}  // namespace vantage
