#include "host_app/replay/transport.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/time/time_zone.h"
#include "common/base/time/timecode.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

class TransportTest : public testing::Test {
  protected:
    void travel(double pulses, std::uint64_t shown) {
        transport_.take({.pulses = pulses}, shown, span_);
    }
    void hold() { transport_.obey(command::ToggleHold{}, 155, span_); }
    void to_live() { transport_.obey(command::ToLive{}, 155, span_); }
    void play(int steps) { transport_.obey(command::ChangeSpeed{steps}, 155, span_); }
    void advance(double dt_s) { transport_.advance(dt_s, 25, span_); }

    Transport transport_;
    std::optional<PastFrameSets::Span> span_ = PastFrameSets::Span{.oldest = 100, .newest = 160};
};

TEST_F(TransportTest, IsLiveAtFirst) {
    EXPECT_TRUE(transport_.is_live());
    EXPECT_FALSE(transport_.is_held());
    EXPECT_FALSE(transport_.pulse());
}

TEST_F(TransportTest, TogglesHold) {
    hold();
    EXPECT_TRUE(transport_.is_held());
    EXPECT_FALSE(transport_.is_live());
    EXPECT_FALSE(transport_.pulse()) << "hold keeps the frame set on screen, wherever it is from";
    hold();
    EXPECT_TRUE(transport_.is_live());
}

TEST_F(TransportTest, StepsFromThePulseOnScreenAndStops) {
    travel(-3, 155);
    EXPECT_EQ(transport_.pulse(), 152);
    EXPECT_FALSE(transport_.is_live());
    span_->newest = 170;
    advance(1);
    EXPECT_EQ(transport_.pulse(), 152) << "the position stays while the stage goes on";
}

TEST_F(TransportTest, GoesToARequestedPulseAndStops) {
    transport_.take({.to_pulse = 131.5}, 155, span_);
    EXPECT_EQ(transport_.pulse(), 131.5);
    EXPECT_EQ(transport_.jumps(), 1u);
    advance(1);
    EXPECT_EQ(transport_.pulse(), 131.5);
    play(1);
    transport_.take({.to_pulse = 90}, 155, span_);
    EXPECT_EQ(transport_.pulse(), 100) << "the oldest pulse";
    EXPECT_EQ(transport_.state().speed, 0);
}

TEST_F(TransportTest, AddsFractionsOfAPulse) {
    travel(-2, 150);
    for (int i = 0; i < 8; ++i) travel(0.25, 148);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 150) << "the pulse on screen does not round it";
}

TEST_F(TransportTest, StopsAtBothEndsOfThePast) {
    travel(-1000, 155);
    EXPECT_EQ(transport_.pulse(), 100);
    travel(+1000, 100);
    EXPECT_EQ(transport_.pulse(), 160);
    EXPECT_FALSE(transport_.is_live()) << "at the newest pulse of the past, not live";
}

TEST_F(TransportTest, LeavesAPositionThatTheBufferDropped) {
    travel(-1000, 155);
    span_ = PastFrameSets::Span{.oldest = 130, .newest = 190};
    travel(+1, 100);
    EXPECT_EQ(transport_.pulse(), 130);
}

TEST_F(TransportTest, StaysLiveWithoutAPast) {
    span_.reset();
    travel(-3, 155);
    EXPECT_TRUE(transport_.is_live());
}

TEST_F(TransportTest, ReturnsToLiveFromHoldAndPast) {
    hold();
    travel(-3, 155);
    EXPECT_TRUE(transport_.is_held()) << "stepping keeps the hold";
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
    EXPECT_DOUBLE_EQ(transport_.state().speed, -2) << "it plays on at its last speed";
    travel(+1, 131);
    EXPECT_DOUBLE_EQ(transport_.state().speed, 0) << "a jog stops it";
}

TEST_F(TransportTest, ReturnsToLiveAtTheNewestPulse) {
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

TEST_F(TransportTest, LoopsBetweenItsMarksWithoutTheOutFrame) {
    transport_ = Transport::of_take(110, 1);
    transport_.obey(command::MarkIn{}, 110, span_);
    transport_.obey(command::MarkOut{}, 120, span_);
    transport_.obey(command::ToggleLoop{}, 115, span_);
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
    transport_.obey(command::ToggleLoop{}, 115, span_);
    for (int i = 0; i < 100; ++i) advance(0.02);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 119) << "stops at the last frame before the out mark";
    transport_.obey(command::CueIn{}, 119, span_);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 110);
    transport_.obey(command::ClearMarks{}, 110, span_);
    transport_.obey(command::CueIn{}, 110, span_);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 100);
}

TEST_F(TransportTest, EntersALoopWhoseOutMarkIsSetAtThePosition) {
    transport_ = Transport::of_take(110, 1);
    transport_.obey(command::MarkIn{}, 110, span_);
    advance(0.42);
    transport_.obey(command::MarkOut{}, 120, span_);
    transport_.obey(command::ToggleLoop{}, 120, span_);
    advance(0.04);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 110);
}

TEST_F(TransportTest, MarkBeyondTheOtherRemovesIt) {
    transport_ = Transport::of_take(110, 1);
    transport_.obey(command::MarkIn{}, 130, span_);
    transport_.obey(command::MarkOut{}, 120, span_);
    EXPECT_FALSE(transport_.state().in);
    EXPECT_EQ(transport_.state().out, 120u);
}

TEST_F(TransportTest, FollowsAMoveThroughATakeAndPlaysOnAfterIt) {
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
    EXPECT_FALSE(transport_.is_moving()) << "a position that stands gets the best frame";
    lead(119);
    EXPECT_EQ(transport_.pulse(), 119);
    EXPECT_EQ(transport_.jumps(), jumps);
    lead(159);
    EXPECT_EQ(transport_.jumps(), jumps + 1) << "a jump";
    lead(1000);
    EXPECT_EQ(transport_.pulse(), 160) << "not beyond the take";
    lead(120);
    lead({});
    EXPECT_EQ(transport_.pulse(), 121);
}

TEST_F(TransportTest, IgnoresTheTimeOfAMoveOnALiveStage) {
    transport_.take({.at_pulse = 120}, 155, span_);
    EXPECT_TRUE(transport_.is_live());
}

class PastTime : public testing::TestWithParam<double> {
  protected:
    PastTime() { use_time_zone("Europe/Stockholm"); }
    /// Ten minutes before and after midnight, local time.
    PastFrameSets::Span span() const {
        const PulseGrid grid(GetParam());
        constexpr std::int64_t midnight_s = 1'795'042'800, ns = 1'000'000'000;
        return {.oldest = grid.index_at_or_before(tai_from_ns((midnight_s - 600) * ns)),
                .newest = grid.index_at_or_before(tai_from_ns((midnight_s + 600) * ns))};
    }
    std::uint64_t find(const std::string& words) const {
        return pulse_in_past(words, span(), GetParam(), 0);
    }
    std::string refusal(const std::string& words) const {
        return thrown_sentence([&] { (void)find(words); });
    }
};

TEST_P(PastTime, FindsEveryPulseByItsTimeCode) {
    const TimecodeClock clock(GetParam());
    std::string last;
    for (std::uint64_t pulse = span().oldest; pulse <= span().newest; pulse += 997) {
        const std::string code = clock.of_pulse(pulse, 0);
        const std::uint64_t found = find(code);
        EXPECT_EQ(clock.of_pulse(found, 0), code);
        EXPECT_LE(pulse - found, 1u) << "above 60 fps two pulses share a number";
    }
}

TEST_P(PastTime, TimeCodeWithoutFramesIsTheFirstOfTheSecond) {
    const std::uint64_t pulse = find("23:55:07");
    const TimecodeClock clock(GetParam());
    EXPECT_TRUE(clock.of_pulse(pulse, 0).starts_with("23:55:07"));
    EXPECT_FALSE(clock.of_pulse(pulse - 1, 0).starts_with("23:55:07"));
}

TEST_P(PastTime, TakesEveryMarkBetweenTheNumbers) {
    EXPECT_EQ(find("23:55:07;12"), find("23:55:07:12"));
    EXPECT_EQ(find("23;55;07;12"), find("23:55:07:12"));
}

TEST_P(PastTime, NamesLabelsThatDoNotExist) {
    EXPECT_NE(refusal("23:55:07:60").find("does not exist"), std::string::npos);
    EXPECT_EQ(
        refusal("23:51:00:00").find("begins this minute with 23:51:00;02") != std::string::npos,
        GetParam() == 29.97)
        << refusal("23:51:00:00");
    EXPECT_EQ(refusal("23:51:00:02"), "");
}

TEST_P(PastTime, AcceptsSecondsFromBothEnds) {
    const auto rate = [&](double seconds) {
        return static_cast<std::uint64_t>(std::llround(seconds * GetParam()));
    };
    EXPECT_EQ(find("12.5"), span().oldest + rate(12.5));
    EXPECT_EQ(find("-3"), span().newest - rate(3));
    EXPECT_EQ(find("-0"), span().newest);
}

TEST_P(PastTime, TakesAnOffsetFromUtc) {
    EXPECT_EQ(find("22:55:07Z"), find("23:55:07"));
    EXPECT_EQ(find("17:55:07-05:00"), find("23:55:07"));
    EXPECT_NE(refusal("23:55:07Z"), "");
}

TEST_P(PastTime, TakesTheLaterTimeInTheHourThatOccursTwice) {
    const PulseGrid grid(GetParam());
    constexpr std::int64_t set_back_s = 1'792'890'000, ns = 1'000'000'000;
    const PastFrameSets::Span night{
        .oldest = grid.index_at_or_before(tai_from_ns((set_back_s - 3600) * ns)),
        .newest = grid.index_at_or_before(tai_from_ns((set_back_s + 3500) * ns))};
    const auto at = [&](const std::string& words) {
        return to_ns(grid.time_of(pulse_in_past(words, night, GetParam(), 0))) / ns;
    };
    EXPECT_NEAR(static_cast<double>(at("02:30:00")), set_back_s + 1800, 1);
    EXPECT_NEAR(static_cast<double>(at("02:30:00+02:00")), set_back_s - 1800, 1);
}

TEST_P(PastTime, RejectsTimesOutsideThePast) {
    EXPECT_NE(refusal("12:00:00:00").find("goes from 23:50"), std::string::npos)
        << refusal("12:00:00");
    EXPECT_NE(refusal("-3000").find("outside the past"), std::string::npos);
    for (const char* words : {"", "abc", "1e", "nan", "inf", "5 s", "23:5", "23:55:07:1", ":::::"})
        EXPECT_NE(refusal(words), "") << words;
}

INSTANTIATE_TEST_SUITE_P(Rates, PastTime, testing::Values(25.0, 29.97, 50.0, 120.0));

}  // namespace

}  // namespace vantage
