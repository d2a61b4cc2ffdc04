#include "host_app/programme/stats/seek_watch.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

const MonotonicTime jumped_at{1h};

ReadyInstant instant_of(std::uint64_t pulse, MonotonicTime taken_up) {
    auto set = std::make_shared<FrameSet>();
    set->trigger_index = pulse;
    ReadyInstant instant;
    instant.set = set;
    instant.taken_up = taken_up;
    instant.fetch_ms = 10;
    instant.prepare_ms = 30;
    return instant;
}

TEST(SeekWatch, MeasuresFromAJumpToTheFirstFrameOfItsTarget) {
    SeekWatch watch;
    watch.follow(1, 40, 20, jumped_at);
    ASSERT_TRUE(watch.is_on());
    watch.saw(instant_of(20, jumped_at), 40, jumped_at + 20ms);
    EXPECT_TRUE(watch.is_on()) << "frames from before the jump do not count";
    watch.follow(1, 40, 20, jumped_at + 40ms);
    watch.saw(instant_of(40, jumped_at + 5ms), 40, jumped_at + 100ms);
    EXPECT_FALSE(watch.is_on());
    EXPECT_EQ(watch.all_ms().count, 1u);
    EXPECT_DOUBLE_EQ(watch.all_ms().max, 100);
    const SeekSteps<Percentiles> steps = watch.steps_ms();
    EXPECT_DOUBLE_EQ(steps.wait.max, 5);
    EXPECT_DOUBLE_EQ(steps.fetch.max, 10);
    EXPECT_DOUBLE_EQ(steps.prepare.max, 30);
    EXPECT_DOUBLE_EQ(steps.picture.max, 55);
}

TEST(SeekWatch, AcceptsAPositionThatHasMovedOn) {
    SeekWatch watch;
    watch.follow(1, 40, 20, jumped_at);
    watch.saw(instant_of(41, jumped_at), 42, jumped_at + 90ms);
    EXPECT_FALSE(watch.is_on());
}

TEST(SeekWatch, DoesNotWaitForTheFrameOnScreen) {
    SeekWatch watch;
    EXPECT_TRUE(watch.has_jumped(1));
    watch.follow(1, 40, 40, jumped_at);
    EXPECT_FALSE(watch.is_on());
    EXPECT_FALSE(watch.has_jumped(1));
    watch.follow(2, 50, 40, jumped_at);
    ASSERT_TRUE(watch.is_on());
    watch.follow(2, std::nullopt, 40, jumped_at);
    EXPECT_FALSE(watch.is_on()) << "it is live again";
    EXPECT_EQ(watch.all_ms().count, 0u);
}

}  // namespace
}  // namespace vantage
