#include "rig_firmware/capture/material/pulse_pacer.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class PulsePacerTest : public testing::Test {
  protected:
    /// Takes the pulse that is due at `now` after 2026-11-21T00:00:00; its index from there.
    std::uint64_t take(std::chrono::nanoseconds now) {
        const Pulse pulse = pacer_.due(day_ + now);
        EXPECT_EQ(pulse.time, grid_.time_of(pulse.index));
        pacer_.take(pulse);
        return pulse.index - grid_.index_at_or_before(day_);
    }

    PulseGrid grid_{10};  // a pulse every 100 ms
    TaiTime day_{seconds(1'795'219'200)};
    PulsePacer pacer_{grid_};
};

TEST_F(PulsePacerTest, BeginsWithTheNextPulseAndMissesNone) {
    EXPECT_EQ(take(milliseconds(530)), 6u);
    EXPECT_EQ(take(milliseconds(601)), 7u);
    EXPECT_EQ(take(milliseconds(750)), 8u) << "late, but no newer one has passed";
    EXPECT_EQ(pacer_.missed(), 0u);
}

TEST_F(PulsePacerTest, LeavesOutWhatHasPassedAndCountsIt) {
    EXPECT_EQ(take(milliseconds(0)), 1u);
    EXPECT_EQ(take(milliseconds(250)), 2u);
    EXPECT_EQ(take(milliseconds(560)), 5u);
    EXPECT_EQ(pacer_.missed(), 2u);
    EXPECT_EQ(take(milliseconds(570)), 6u);
    EXPECT_EQ(pacer_.missed(), 2u);
    EXPECT_EQ(pacer_.clock_steps(), 0u);
}

TEST_F(PulsePacerTest, NeverGivesAPulseTwice) {
    EXPECT_EQ(take(milliseconds(1000)), 11u);
    EXPECT_EQ(take(milliseconds(1000)), 12u);
    EXPECT_EQ(take(milliseconds(1100)), 13u);
}

TEST_F(PulsePacerTest, GoesBackWithAClockThatIsSetBack) {
    EXPECT_EQ(take(seconds(40)), 401u);
    EXPECT_EQ(take(seconds(3)), 31u);
    EXPECT_EQ(take(milliseconds(3100)), 32u);
    EXPECT_EQ(pacer_.clock_steps(), 1u);
    EXPECT_EQ(pacer_.missed(), 0u);
}

TEST_F(PulsePacerTest, WhatAClockLeapsOverWasNotMissed) {
    const MonotonicTime start(seconds(100));
    const auto take_at = [&](std::chrono::nanoseconds tai, std::chrono::nanoseconds passed) {
        Pulse pulse = pacer_.due(day_ + tai);
        pulse.monotonic = start + passed;
        pacer_.take(pulse);
    };
    take_at(seconds(1), seconds(0));
    take_at(std::chrono::hours(1), milliseconds(350));
    EXPECT_EQ(pacer_.missed(), 2u) << "the pulses of the 350 ms that passed";
    EXPECT_EQ(pacer_.clock_steps(), 1u);
    take_at(std::chrono::hours(1) + seconds(2), seconds(2) + milliseconds(350));
    EXPECT_EQ(pacer_.missed(), 2u + 19u) << "two seconds without a frame are missed ones";
    EXPECT_EQ(pacer_.clock_steps(), 1u);
}

TEST(PulsePacer, WaitsOnTheClock) {
    PulsePacer slow(PulseGrid(0.01));
    EXPECT_FALSE(slow.wait_next(milliseconds(1)) && slow.wait_next(milliseconds(1)));
    PulsePacer fast(PulseGrid(1000));
    for (int i = 0; i < 5; ++i) {
        const auto pulse = fast.wait_next(seconds(1));
        ASSERT_TRUE(pulse);
        EXPECT_GE(TaiClock::now(), pulse->time);
    }
}

}  // namespace
}  // namespace vantage
