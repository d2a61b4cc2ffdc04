#include "host_app/session/report/rig_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {

namespace {

TEST(RigWordsTest, DescribeTheClock) {
    RigStatus rig;
    EXPECT_EQ(short_clock_words(rig), "") << "a disconnected rig has no clock state";
    rig.connected = true;
    EXPECT_EQ(short_clock_words(rig), "no PTP");
    rig.sync.disciplined = true;
    rig.sync.ptp_offset_ns = -123.4;
    EXPECT_EQ(short_clock_words(rig), "PTP -123 ns");
    rig.same_clock = true;
    EXPECT_EQ(short_clock_words(rig), "this computer");
}

TEST(RigWordsTest, DescribeAgeAndResidualOfACalibration) {
    const auto now =
        std::chrono::sys_days(std::chrono::year(2026) / 3 / 13) + std::chrono::hours(9);
    RigHealth health;
    EXPECT_EQ(calibration_words(health, now), "");
    health.calibration_row_rms_px = 0.213f;
    health.calibration_date = "2026-03-01T18:00:00Z";
    EXPECT_EQ(calibration_words(health, now), "12 d, 0.21 px");
    health.calibration_date = "2027-03-01";
    EXPECT_EQ(calibration_words(health, now), "0 d, 0.21 px") << "a date in the future has age 0";
    health.calibration_date = "yesterday";
    EXPECT_EQ(calibration_words(health, now), "");
}

}  // namespace

namespace {

using testing::HasSubstr;

RigStatus quiet_rig() {
    RigStatus rig;
    rig.rig = "north";
    rig.connected = true;
    return rig;
}

TEST(RigSilence, NamesTheCamerasIfTheyDeliverNothing) {
    const RigStatus rig = quiet_rig();
    EXPECT_FALSE(delivers(rig, {rig}));
    EXPECT_THAT(silence_of(rig), HasSubstr("its cameras deliver no frames"));
}

TEST(RigSilence, DistinguishesAStuckRigFromOneWithoutCameras) {
    RigStatus rig = quiet_rig();
    rig.health.captured_hz = 25;
    EXPECT_THAT(silence_of(rig), HasSubstr("captures, but sends nothing"));
    // An armed rig that has had its first pulse must send frames.
    rig.sync.role = RigSync::Role::follow;
    rig.sync.ready = true;
    rig.sync.first_pulse = 7;
    EXPECT_FALSE(waits_for_a_host(rig));
    EXPECT_THAT(silence_of(rig), HasSubstr("captures, but sends nothing"));
}

TEST(RigSilence, AsksForAHostIfTheRigIsArmed) {
    RigStatus rig = quiet_rig();
    rig.sync.role = RigSync::Role::lead;
    rig.sync.ready = true;
    EXPECT_TRUE(waits_for_a_host(rig));
    EXPECT_THAT(silence_of(rig), HasSubstr("vantage live"));
}

TEST(RigSilence, IsEmptyForARigThatSendsOrHasAnotherTrouble) {
    RigStatus rig = quiet_rig();
    rig.health.published_hz = 5;
    EXPECT_TRUE(delivers(rig, {rig}));
    EXPECT_EQ(silence_of(rig), "");
    rig = quiet_rig();
    rig.connected = false;
    EXPECT_EQ(silence_of(rig), "") << "its trouble is that it is disconnected";
}

}  // namespace

}  // namespace vantage
