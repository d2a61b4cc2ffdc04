#include "host_app/replay/past_time.h"

#include <gtest/gtest.h>

#include "common/base/time/time_zone.h"
#include "common/base/time/timecode.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

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
