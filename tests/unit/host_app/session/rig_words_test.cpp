#include "host_app/session/report/rig_words.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(RigWordsTest, SayHowAClockStands) {
    RigStatus rig;
    EXPECT_EQ(short_clock_words(rig), "") << "nothing is known of one that is away";
    rig.connected = true;
    EXPECT_EQ(short_clock_words(rig), "no PTP");
    rig.sync.disciplined = true;
    rig.sync.ptp_offset_ns = -123.4;
    EXPECT_EQ(short_clock_words(rig), "PTP -123 ns");
    rig.same_clock = true;
    EXPECT_EQ(short_clock_words(rig), "this computer");
}

TEST(RigWordsTest, SayHowOldACalibrationIsAndHowGood) {
    const auto now =
        std::chrono::sys_days(std::chrono::year(2026) / 3 / 13) + std::chrono::hours(9);
    RigHealth health;
    EXPECT_EQ(calibration_words(health, now), "");
    health.calibration_row_rms_px = 0.213f;
    health.calibration_date = "2026-03-01T18:00:00Z";
    EXPECT_EQ(calibration_words(health, now), "12 d, 0.21 px");
    health.calibration_date = "2027-03-01";
    EXPECT_EQ(calibration_words(health, now), "0 d, 0.21 px") << "a clock is wrong somewhere";
    health.calibration_date = "yesterday";
    EXPECT_EQ(calibration_words(health, now), "");
}

}  // namespace
}  // namespace vantage
