#include "host_app/ltc/smpte_code.h"

#include <gtest/gtest.h>

#include "host_app/ltc/ltc_sound.h"

namespace vantage {
namespace {

std::string code_at(const SmpteCount& count, std::int64_t frame) {
    return count.code_of(frame).text();
}

TEST(SmpteCode, RoundTrips) {
    for (const std::string text : {"00:00:00:00", "23:59:59:24", "10:02:03;28"})
        EXPECT_EQ(SmpteCode::parse(text)->text(), text);
    for (const std::string text : {"", "24:00:00:00", "10:60:00:00", "10:00:00.00", "1:00:00:00",
                                   "10:00:00:0x", "10-00:00:00", "10:00:00:000"})
        EXPECT_FALSE(SmpteCode::parse(text)) << text;
}

TEST(SmpteCount, RoundTripsEveryFrameOfADay) {
    for (const SmpteCount count : {SmpteCount{24}, SmpteCount{25}, SmpteCount{30},
                                   SmpteCount{30, true}, SmpteCount{50}, SmpteCount{60, true}})
        for (std::int64_t frame = 0; frame < count.frames(); frame += 997)
            ASSERT_EQ(count.frame_of(count.code_of(frame)), frame)
                << count.numbers_a_second << " " << frame;
}

TEST(SmpteCount, DropsNumbersOfEveryMinuteButEachTenth) {
    const SmpteCount ntsc{30, true};
    EXPECT_EQ(code_at(ntsc, 1799), "00:00:59;29");
    EXPECT_EQ(code_at(ntsc, 1800), "00:01:00;02");
    EXPECT_EQ(code_at(ntsc, 17982), "00:10:00;00");
    EXPECT_EQ(ntsc.frames(), 2589408);
    EXPECT_FALSE(ntsc.frame_of(*SmpteCode::parse("00:01:00;00"))) << "there is no such number";
    EXPECT_FALSE(ntsc.frame_of(*SmpteCode::parse("00:01:00:02"))) << "is of another count";
    EXPECT_FALSE(SmpteCount{25}.frame_of(*SmpteCode::parse("00:00:00:25")));
}

TEST(SmpteCount, MeasuresTheShorterWayAroundTheDay) {
    const SmpteCount pal{25};
    EXPECT_EQ(pal.between(3, pal.frames() - 2), 5);
    EXPECT_EQ(pal.between(pal.frames() - 2, 3), -5);
    EXPECT_EQ(code_at(pal, pal.frames() + 1), "00:00:00:01");
    EXPECT_EQ(code_at(pal, -1), "23:59:59:24");
}

class LtcFlywheelTest : public testing::Test {
  protected:
    std::string next(std::optional<std::int64_t> picture) {
        const auto code =
            wheel_.next(picture ? std::optional(count_.code_of(*picture)) : std::nullopt);
        return code ? code->text() : "";
    }
    SmpteCount count_{25};
    LtcFlywheel wheel_{count_};
};

TEST_F(LtcFlywheelTest, CountsEvenlyWherePicturesRepeatOrAreMissing) {
    EXPECT_EQ(next(std::nullopt), "");
    EXPECT_EQ(next(100), "00:00:04:00");
    EXPECT_EQ(next(100), "00:00:04:01");
    EXPECT_EQ(next(std::nullopt), "00:00:04:02");
    EXPECT_EQ(next(101), "00:00:04:03");
    EXPECT_EQ(next(104), "00:00:04:04");
    EXPECT_EQ(wheel_.jumps(), 0u);
}

TEST_F(LtcFlywheelTest, FollowsAJumpAndStopsWithThePictures) {
    next(100);
    EXPECT_EQ(next(1000), "00:00:40:00");
    EXPECT_EQ(next(1001), "00:00:40:01");
    EXPECT_EQ(wheel_.jumps(), 1u);
    for (int i = 0; i < 60; ++i) next(1002);
    EXPECT_EQ(next(1002), "00:00:40:02");
    EXPECT_EQ(next(1002), "00:00:40:02");
    EXPECT_EQ(next(1003), "00:00:40:03");
}

}  // namespace
}  // namespace vantage
