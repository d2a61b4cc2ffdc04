#include "host_app/replay/transport.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vantage {
namespace {

class TransportTest : public testing::Test {
  protected:
    void travel(double pulses, std::uint64_t shown) {
        transport_.take({.pulses = pulses}, shown, span_);
    }
    void hold() { transport_.take({.toggle_hold = true}, 155, span_); }
    void to_live() { transport_.take({.to_live = true}, 155, span_); }
    void play(int steps) { transport_.take({.speed_steps = steps}, 155, span_); }
    void advance(double dt_s) { transport_.advance(dt_s, 25, span_); }

    Transport transport_;
    std::optional<PastFrameSets::Span> span_ = PastFrameSets::Span{.oldest = 100, .newest = 160};
};

TEST_F(TransportTest, IsLiveUntilSomebodySaysOtherwise) {
    EXPECT_TRUE(transport_.is_live());
    EXPECT_FALSE(transport_.is_held());
    EXPECT_FALSE(transport_.pulse());
}

TEST_F(TransportTest, HoldsAndLetsGo) {
    hold();
    EXPECT_TRUE(transport_.is_held());
    EXPECT_FALSE(transport_.is_live());
    EXPECT_FALSE(transport_.pulse()) << "held is the instant that is shown, wherever it is from";
    hold();
    EXPECT_TRUE(transport_.is_live());
}

TEST_F(TransportTest, GoesFromThePulseThatIsShownAndStaysThere) {
    travel(-3, 155);
    EXPECT_EQ(transport_.pulse(), 152);
    EXPECT_FALSE(transport_.is_live());
    span_->newest = 170;
    advance(1);
    EXPECT_EQ(transport_.pulse(), 152) << "the stage goes on and the past does not";
}

TEST_F(TransportTest, GoesToThePulseThatIsAskedForAndStandsThere) {
    transport_.take({.to_pulse = 131.5}, 155, span_);
    EXPECT_EQ(transport_.pulse(), 131.5);
    EXPECT_EQ(transport_.jumps(), 1u);
    advance(1);
    EXPECT_EQ(transport_.pulse(), 131.5);
    play(1);
    transport_.take({.to_pulse = 90}, 155, span_);
    EXPECT_EQ(transport_.pulse(), 100) << "the oldest that there is";
    EXPECT_EQ(transport_.state().speed, 0);
}

TEST_F(TransportTest, AddsUpPartsOfAPulse) {
    travel(-2, 150);
    for (int i = 0; i < 8; ++i) travel(0.25, 148);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 150) << "what is shown meanwhile does not round it";
}

TEST_F(TransportTest, StopsAtBothEndsOfWhatIsKept) {
    travel(-1000, 155);
    EXPECT_EQ(transport_.pulse(), 100);
    travel(+1000, 100);
    EXPECT_EQ(transport_.pulse(), 160);
    EXPECT_FALSE(transport_.is_live()) << "at the newest pulse of the past, not live";
}

TEST_F(TransportTest, MovesOnFromWhatTheBufferHasDropped) {
    travel(-1000, 155);
    span_ = PastFrameSets::Span{.oldest = 130, .newest = 190};
    travel(+1, 100);
    EXPECT_EQ(transport_.pulse(), 130);
}

TEST_F(TransportTest, StaysLiveWhereNoPastIsKept) {
    span_.reset();
    travel(-3, 155);
    EXPECT_TRUE(transport_.is_live());
}

TEST_F(TransportTest, ComesBackToLiveFromHoldAndPast) {
    hold();
    travel(-3, 155);
    EXPECT_TRUE(transport_.is_held()) << "going through the past lets go of nothing";
    to_live();
    EXPECT_TRUE(transport_.is_live());
    EXPECT_FALSE(transport_.pulse());
}

TEST_F(TransportTest, PlaysThePastAtEverySpeedOfTheShuttle) {
    travel(-35, 155);
    play(+1);
    EXPECT_DOUBLE_EQ(transport_.state().speed, 0.1);
    EXPECT_TRUE(transport_.is_moving());
    EXPECT_FALSE(transport_.is_live());
    advance(0.4);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 121);
    play(+5);
    EXPECT_DOUBLE_EQ(transport_.state().speed, 1);
    play(+9);
    EXPECT_DOUBLE_EQ(transport_.state().speed, 2);
    advance(0.4);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 141);
    play(-14);
    EXPECT_DOUBLE_EQ(transport_.state().speed, -2);
    advance(0.2);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 131);
    hold();
    advance(1);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 131);
    EXPECT_FALSE(transport_.is_moving());
    hold();
    EXPECT_DOUBLE_EQ(transport_.state().speed, -2) << "goes on as it went";
    travel(+1, 131);
    EXPECT_DOUBLE_EQ(transport_.state().speed, 0) << "a jog stops it";
}

TEST_F(TransportTest, IsLiveAgainWherePlayingComesUpToTheStage) {
    travel(-5, 155);
    play(+7);
    ASSERT_DOUBLE_EQ(transport_.state().speed, 2);
    advance(0.1);
    EXPECT_FALSE(transport_.is_live());
    for (int i = 0; i < 10; ++i) advance(0.1);
    EXPECT_TRUE(transport_.is_live());
}

TEST_F(TransportTest, StopsAtTheEndsOfATake) {
    transport_ = Transport::of_take(100, 1);
    EXPECT_TRUE(transport_.is_moving());
    for (int i = 0; i < 60; ++i) advance(0.04);
    EXPECT_FALSE(transport_.is_at_end()) << "the last pulse is shown too";
    EXPECT_DOUBLE_EQ(std::floor(*transport_.pulse() + 1e-6), 160);
    for (int i = 0; i < 2; ++i) advance(0.04);
    EXPECT_TRUE(transport_.is_at_end());
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 160);
    EXPECT_DOUBLE_EQ(transport_.state().speed, 0);
    to_live();
    EXPECT_FALSE(transport_.is_live()) << "a take has no live";
    EXPECT_DOUBLE_EQ(transport_.state().speed, 1);
    transport_ = Transport::of_take(102, -1);
    for (int i = 0; i < 4; ++i) advance(0.04);
    EXPECT_TRUE(transport_.is_at_end());
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 100);
}

TEST_F(TransportTest, LoopsBetweenItsMarksAndLeavesTheOutFrameOut) {
    transport_ = Transport::of_take(110, 1);
    transport_.take({.mark_in = true}, 110, span_);
    transport_.take({.mark_out = true}, 120, span_);
    transport_.take({.toggle_loop = true}, 115, span_);
    double most = 0, least = 1000;
    for (int i = 0; i < 100; ++i) {
        advance(0.02);
        most = std::max(most, *transport_.pulse());
        least = std::min(least, *transport_.pulse());
    }
    EXPECT_LT(most, 120);
    EXPECT_GT(most, 119);
    EXPECT_GE(least, 110);
    EXPECT_FALSE(transport_.is_at_end());
    transport_.take({.toggle_loop = true}, 115, span_);
    for (int i = 0; i < 100; ++i) advance(0.02);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 119) << "stops at the last frame before the out mark";
    transport_.take({.cue = true}, 119, span_);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 110);
    transport_.take({.clear_marks = true}, 110, span_);
    transport_.take({.cue = true}, 110, span_);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 100);
}

TEST_F(TransportTest, EntersALoopWhoseOutMarkIsSetWhereItPlays) {
    transport_ = Transport::of_take(110, 1);
    transport_.take({.mark_in = true}, 110, span_);
    advance(0.42);
    transport_.take({.mark_out = true, .toggle_loop = true}, 120, span_);
    advance(0.04);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 110);
}

TEST_F(TransportTest, AMarkBeyondTheOtherTakesItAway) {
    transport_ = Transport::of_take(110, 1);
    transport_.take({.mark_in = true}, 130, span_);
    transport_.take({.mark_out = true}, 120, span_);
    EXPECT_FALSE(transport_.state().in);
    EXPECT_EQ(transport_.state().out, 120u);
}

TEST_F(TransportTest, IsLedThroughATakeByAFlightAndGoesOnByItselfAfterIt) {
    transport_ = Transport::of_take(110, 1);
    const auto lead = [&](std::optional<double> pulse) {
        transport_.take({.at_pulse = pulse}, 110, span_);
        advance(0.04);
    };
    lead(120.5);
    EXPECT_EQ(transport_.pulse(), 120.5);
    EXPECT_TRUE(transport_.is_moving());
    const std::uint64_t jumps = transport_.jumps();
    lead(120.5);
    EXPECT_EQ(transport_.pulse(), 120.5);
    EXPECT_FALSE(transport_.is_moving()) << "what stands is worth the best picture";
    lead(119);
    EXPECT_EQ(transport_.pulse(), 119);
    EXPECT_EQ(transport_.jumps(), jumps);
    lead(159);
    EXPECT_EQ(transport_.jumps(), jumps + 1) << "elsewhere";
    lead(1000);
    EXPECT_EQ(transport_.pulse(), 160) << "not beyond the take";
    lead(120);
    lead({});
    EXPECT_EQ(transport_.pulse(), 121);
}

TEST_F(TransportTest, IsNotLedOnALiveStage) {
    transport_.take({.at_pulse = 120}, 155, span_);
    EXPECT_TRUE(transport_.is_live());
}

}  // namespace
}  // namespace vantage
