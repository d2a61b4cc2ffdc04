#include "host_app/takes/clock_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/time/time_zone.h"
#include "common/base/time/timecode.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

/// 2026-11-22T20:15:00 in Stockholm.
constexpr std::time_t evening = 1'795'374'900;

class ClockTimeTest : public testing::Test {
  protected:
    ClockTimeTest() { use_time_zone("Europe/Stockholm"); }
};

TEST_F(ClockTimeTest, FindsTheLastBeginAndTheFirstEndAfterIt) {
    const ClockSpan today = clock_span("20:14:00", "20:14:30", evening);
    EXPECT_EQ(today.from.utc_s, evening - 60);
    EXPECT_EQ(today.to.utc_s, evening - 30);
    const ClockSpan yesterday = clock_span("20:16:00", "20:17:00", evening);
    EXPECT_EQ(yesterday.from.utc_s, evening + 60 - 86400);
    EXPECT_EQ(yesterday.to.utc_s, evening + 120 - 86400);
    const ClockSpan midnight = clock_span("23:59:50", "00:00:10", evening + 6 * 3600);
    EXPECT_EQ(midnight.to.utc_s - midnight.from.utc_s, 20);
    const ClockSpan open = clock_span("20:14:00", "20:30:00", evening);
    EXPECT_EQ(open.to.utc_s, evening + 900) << "what is still to come may be asked for";
}

TEST_F(ClockTimeTest, DatesAreRead) {
    const ClockSpan span = clock_span("2026-11-22T20:15:00", "2026-11-22T20:15:01:05", 0);
    EXPECT_EQ(span.from.utc_s, evening);
    EXPECT_EQ(span.to.utc_s, evening + 1);
    EXPECT_EQ(span.to.frame, 5);
    EXPECT_EQ(clock_span("2026-07-01T12:00:00", "2026-07-01T12:00:01", 0).from.utc_s, 1'782'900'000)
        << "summer time";
}

TEST_F(ClockTimeTest, ConvertsATimeCodeToItsPulse) {
    for (const double rate : {23.976, 25.0, 29.97, 50.0, 60.0})
        for (const int offset_s : {0, 37}) {
            const PulseGrid pulses(rate);
            const TimecodeClock clock(rate);
            const std::uint64_t pulse = pulses.index_at_or_before(
                TaiTime(std::chrono::seconds(evening + offset_s) + std::chrono::milliseconds(400)));
            const std::string code = clock.of_pulse(pulse, offset_s);
            const ClockSpan span = clock_span(code, "23:00:00", evening + 30);
            EXPECT_EQ(pulse_of(span.from, pulses, offset_s), pulse) << code << " at " << rate;
        }
    const ClockSpan whole = clock_span("20:15:00", "20:15:01", evening + 30);
    EXPECT_EQ(pulse_of(whole.from, PulseGrid(25), 37), 25u * (evening + 37));
    EXPECT_THAT(thrown_sentence([&] {
                    (void)pulse_of(clock_span("20:15:00:40", "20:16:00", evening + 30).from,
                                   PulseGrid(25), 37);
                }),
                testing::HasSubstr("does not exist in time code at 25 pulses"));
}

TEST_F(ClockTimeTest, AcceptsAnOffsetFromUtc) {
    EXPECT_EQ(clock_span("19:14:00Z", "20:14:30+01:00", evening).from.utc_s, evening - 60);
    EXPECT_EQ(clock_span("19:14:00Z", "20:14:30+01:00", evening).to.utc_s, evening - 30);
    const ClockSpan dated = clock_span("2026-11-22T14:15:00-0500", "2026-11-22T19:15:01:05Z", 0);
    EXPECT_EQ(dated.from.utc_s, evening);
    EXPECT_EQ(dated.to.utc_s, evening + 1);
    EXPECT_EQ(dated.to.frame, 5);
    EXPECT_NE(thrown_sentence([&] { (void)clock_span("20:14:00+25:00", "20:15:00", evening); }),
              "");
}

TEST_F(ClockTimeTest, TakesTheLaterTimeInTheHourThatOccursTwice) {
    // Clocks were set back from 03:00 to 02:00 at 2026-10-25T01:00:00Z.
    constexpr std::time_t set_back = 1'792'890'000;
    testing::internal::CaptureStderr();
    EXPECT_EQ(clock_span("02:30:00", "02:31:00", set_back + 3600).from.utc_s, set_back + 1800);
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_THAT(log, testing::HasSubstr("occurs twice"));
    EXPECT_THAT(log, testing::HasSubstr("2026-10-25T01:30:00Z"));
    EXPECT_THAT(log, testing::HasSubstr("say 00:30:00Z for the other"));
    const ClockSpan first = clock_span("02:30:00", "02:31:00", set_back - 60);
    EXPECT_EQ(first.from.utc_s, set_back - 1800) << "the later one is still to come";
    EXPECT_EQ(first.to.utc_s, set_back - 1740);
    EXPECT_EQ(clock_span("02:30:00+02:00", "02:31:00+02:00", set_back + 3600).from.utc_s,
              set_back - 1800);
    EXPECT_THAT(thrown_sentence([&] {
                    (void)clock_span("2026-03-29T02:30:00", "2026-03-29T04:00:00", set_back);
                }),
                testing::HasSubstr("skipped"));
}

TEST_F(ClockTimeTest, RefusesInvalidTimes) {
    for (const char* text : {"", "20:15", "20:15:00:", "20:15:00:1x", "25:00:00", "20:60:00", "-1",
                             "2026-13-01T20:15:00", "2026-02-30T20:15:00", "T20:15:00",
                             "2026-11-22 20:15:00", "20:15:00 "})
        EXPECT_NE(thrown_sentence([&] { (void)clock_span(text, "23:00:00", evening); }), "")
            << text;
    EXPECT_THAT(thrown_sentence([&] {
                    (void)clock_span("2026-11-22T20:15:00", "2026-11-22T20:15:00", evening);
                }),
                testing::HasSubstr("is not before"));
}

}  // namespace
}  // namespace vantage
