#include "common/base/time/timecode.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "common/base/time/time_zone.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

/// 2026-10-02T00:00:00Z, in seconds of UTC.
constexpr std::int64_t midnight_s = 1'790'899'200;

class TimecodeTest : public testing::Test {
  protected:
    TimecodeTest() { use_time_zone("UTC"); }
    ~TimecodeTest() override { use_time_zone("UTC"); }
};

TaiTime at_utc(std::int64_t seconds, int tai_offset_s = 0) {
    return TaiTime(std::chrono::seconds(seconds + tai_offset_s));
}

/// The first frame of the day.
std::uint64_t first_frame(const PulseGrid& grid) {
    const std::uint64_t before = grid.index_at_or_before(at_utc(midnight_s));
    return grid.time_of(before) == at_utc(midnight_s) ? before : before + 1;
}

/// The code of the n-th frame of the day.
std::string nth(double rate_hz, std::uint64_t n) {
    const PulseGrid grid(rate_hz);
    return TimecodeClock(rate_hz).at(grid.time_of(first_frame(grid) + n), 0);
}

TEST_F(TimecodeTest, CountsTheFramesOfEverySecond) {
    EXPECT_EQ(nth(25, 0), "00:00:00:00");
    EXPECT_EQ(nth(25, 24), "00:00:00:24");
    EXPECT_EQ(nth(25, 25), "00:00:01:00");
    EXPECT_EQ(nth(25, 25 * 86'400 - 1), "23:59:59:24");
    EXPECT_EQ(nth(50, 49), "00:00:00:49");
}

TEST_F(TimecodeTest, ShowsAFrameUntilTheNextOneBegins) {
    const TimecodeClock clock(25);
    EXPECT_EQ(clock.at(at_utc(midnight_s) + std::chrono::milliseconds(39), 0), "00:00:00:00");
    EXPECT_EQ(clock.at(at_utc(midnight_s) + std::chrono::milliseconds(40), 0), "00:00:00:01");
    EXPECT_EQ(clock.at(at_utc(midnight_s) - std::chrono::nanoseconds(1), 0), "23:59:59:24");
}

TEST_F(TimecodeTest, SubtractsTheTaiOffset) {
    const TimecodeClock clock(25);
    EXPECT_EQ(clock.at(at_utc(midnight_s + 3600, 37), 37), "01:00:00:00");
    EXPECT_EQ(clock.at(at_utc(midnight_s + 3600), 0), "01:00:00:00");
}

TEST_F(TimecodeTest, DropsNumbersButNoFramesAt2997) {
    EXPECT_EQ(nth(29.97, 0), "00:00:00;00");
    EXPECT_EQ(nth(29.97, 1799), "00:00:59;29");
    EXPECT_EQ(nth(29.97, 1800), "00:01:00;02") << "numbers 00 and 01 of a minute are left out";
    EXPECT_EQ(nth(29.97, 1800 + 1797), "00:01:59;29");
    EXPECT_EQ(nth(29.97, 1800 + 1798), "00:02:00;02");
    EXPECT_EQ(nth(29.97, 17'981), "00:09:59;29");
    EXPECT_EQ(nth(29.97, 17'982), "00:10:00;00") << "but not of each tenth";
    EXPECT_EQ(nth(29.97, 107'892), "01:00:00;00");
    EXPECT_EQ(nth(29.97, 2'589'407), "23:59:59;29");
}

TEST_F(TimecodeTest, DropsFourNumbersAt5994) {
    EXPECT_EQ(nth(59.94, 3599), "00:00:59;59");
    EXPECT_EQ(nth(59.94, 3600), "00:01:00;04");
    EXPECT_EQ(nth(59.94, 35'963), "00:09:59;59");
    EXPECT_EQ(nth(59.94, 35'964), "00:10:00;00");
    EXPECT_EQ(nth(59.94, 215'784), "01:00:00;00");
}

TEST_F(TimecodeTest, DropFrameIsNeverFiveFramesOffTheClock) {
    const TimecodeClock clock(29.97);
    for (std::int64_t s = 1; s < 86'400; s += 7) {
        const std::string code = clock.at(at_utc(midnight_s + s), 0);
        const double shown_s = std::stoi(code.substr(0, 2)) * 3600.0 +
                               std::stoi(code.substr(3, 2)) * 60.0 + std::stoi(code.substr(6, 2)) +
                               std::stoi(code.substr(9, 2)) / 29.97;
        ASSERT_NEAR(shown_s, static_cast<double>(s), 5 / 29.97) << code;
    }
}

TEST_F(TimecodeTest, NoTwoFramesShareANumberButTheDaysLast) {
    const PulseGrid grid(29.97);
    const TimecodeClock clock(29.97);
    const std::uint64_t end = first_frame(grid) + 2'589'408;
    std::string before = clock.at(grid.time_of(end - 20'000), 0);
    for (std::uint64_t k = end - 19'999; k < end; ++k) {
        const std::string code = clock.at(grid.time_of(k), 0);
        ASSERT_GT(code, before);
        before = code;
    }
    EXPECT_EQ(clock.at(grid.time_of(end), 0), "23:59:59;29");
    const std::uint64_t tomorrow = grid.index_at_or_before(at_utc(midnight_s + 86'400)) + 1;
    EXPECT_EQ(clock.at(grid.time_of(tomorrow), 0), "00:00:00;00");
}

TEST_F(TimecodeTest, OtherBroadcastRatesAreNotDropFrame) {
    EXPECT_EQ(nth(23.976, 0), "00:00:00:00");
    EXPECT_EQ(nth(30, 1800), "00:01:00:00");
    EXPECT_EQ(nth(60, 3600), "00:01:00:00");
    const std::string hour =
        TimecodeClock(23.976).at(at_utc(midnight_s + 3600) + std::chrono::milliseconds(50), 0);
    EXPECT_EQ(hour.substr(0, 8), "01:00:00") << "by the clock";
}

TEST_F(TimecodeTest, FramesShareANumberAbove60Fps) {
    EXPECT_EQ(nth(120, 0), "00:00:00:00");
    EXPECT_EQ(nth(120, 1), "00:00:00:00");
    EXPECT_EQ(nth(120, 119), "00:00:00:59");
    EXPECT_EQ(nth(119.88, 7200), "00:01:00;04");
    for (const double rate : {200.0, 1000.0})
        for (std::uint64_t n = 0; n < 2000; ++n) {
            const std::string code = nth(rate, n);
            ASSERT_EQ(code.size(), 11u) << code;
            ASSERT_LT(std::stoi(code.substr(9)), 60) << code;
        }
}

TEST_F(TimecodeTest, FollowsLocalTimeInSummerAndWinter) {
    use_time_zone("Europe/Stockholm");
    const TimecodeClock clock(25);
    EXPECT_EQ(clock.at(at_utc(midnight_s, 37), 37), "02:00:00:00");
    constexpr std::int64_t december_s = midnight_s + 70 * 86'400;
    EXPECT_EQ(clock.at(at_utc(december_s, 37), 37), "01:00:00:00");
    use_time_zone("Asia/Kolkata");
    EXPECT_EQ(clock.at(at_utc(midnight_s, 37), 37), "05:30:00:00");
    EXPECT_EQ(TimecodeClock(29.97).at(at_utc(midnight_s - 19'800 + 1), 0).substr(0, 8), "00:00:00")
        << "drop-frame code begins at the house's midnight";
}

TEST_F(TimecodeTest, FindsTimeZonesByName) {
    EXPECT_TRUE(is_time_zone("UTC"));
    EXPECT_TRUE(is_time_zone("America/Argentina/Buenos_Aires"));
    for (const char* name : {"", "Europe/Stokholm", "Europe", "/etc/localtime", "../../etc/passwd"})
        EXPECT_FALSE(is_time_zone(name)) << name;
    EXPECT_EQ(thrown_sentence([] { use_time_zone("Mars/Olympus"); }),
              "the time zone 'Mars/Olympus' is not known here; timedatectl list-timezones lists "
              "them");
}

TEST(TimeLabel, ReadsBothMarksAndLabelsWithoutFrames) {
    const std::optional<TimeLabel> label = TimeLabel::parse("10:01:02;03");
    ASSERT_TRUE(label);
    EXPECT_EQ(label->hours, 10);
    EXPECT_EQ(label->frame, 3);
    EXPECT_TRUE(label->matches(*TimeLabel::parse("10:01:02:03")));
    EXPECT_FALSE(label->matches(*TimeLabel::parse("10:01:02:04")));
    EXPECT_TRUE(TimeLabel::parse("10:01:02")->matches(*label));
    for (const char* text : {"", "10:01", "24:00:00", "10:60:00:00", "10:01:02:0", "10:01:02:033",
                             "1a:00:00:00", "10-01-02-03", " 10:01:02"})
        EXPECT_FALSE(TimeLabel::parse(text)) << text;
}

TEST(TimeLabel, IsFoundInDropFrameCodeWithEitherMark) {
    const TimecodeClock clock(29.97);
    const PulseGrid grid(29.97);
    const std::uint64_t first = grid.index_at_or_before(tai_from_ns(1'795'042'800'000'000'000));
    const std::uint64_t pulse = first + 4321;
    std::string code = clock.of_pulse(pulse, 0);
    ASSERT_EQ(code[8], ';');
    EXPECT_EQ(clock.find(*TimeLabel::parse(code), first, first + 9000, 0), pulse);
    code[8] = ':';
    EXPECT_EQ(clock.find(*TimeLabel::parse(code), first, first + 9000, 0), pulse);
    EXPECT_FALSE(clock.find(*TimeLabel::parse(code), first, pulse - 1, 0));
    EXPECT_NE(clock.why_never(*TimeLabel::parse("10:01:00:01")), "");
    EXPECT_EQ(clock.why_never(*TimeLabel::parse("10:10:00:01")), "");
    EXPECT_NE(clock.why_never(*TimeLabel::parse("10:10:00:30")), "");
    EXPECT_EQ(TimecodeClock(25).why_never(*TimeLabel::parse("10:01:00:00")), "");
}

}  // namespace
}  // namespace vantage
