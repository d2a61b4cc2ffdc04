#include "common/receive/rig_status.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

using testing::HasSubstr;

RigStatus good_rig() {
    RigStatus rig;
    rig.rig = "north";
    rig.endpoint = "tcp://north:5600";
    rig.connected = true;
    rig.stage_rate_hz = rig.sync.rate_hz = 25;
    return rig;
}

TEST(RigStatus, AGoodRigHasNoTrouble) { EXPECT_EQ(trouble_of(good_rig()), ""); }

TEST(RigStatus, NamesARigAtAnotherRateWithBoth) {
    RigStatus rig = good_rig();
    rig.sync.rate_hz = 2;
    EXPECT_EQ(trouble_of(rig),
              "it runs at 2 Hz and the stage at 25 Hz: give both the same rate_hz");
}

TEST(RigStatus, TreatsNotationsOfBroadcastRatesAsEqual) {
    RigStatus rig = good_rig();
    rig.stage_rate_hz = 29.97;
    rig.sync.rate_hz = 30000.0 / 1001;
    EXPECT_EQ(rate_warning(rig), "");
    rig.sync.rate_hz = 30;
    EXPECT_THAT(rate_warning(rig), HasSubstr("30 Hz and the stage at 29.97 Hz"));
    rig.sync.rate_hz = 0;
    EXPECT_EQ(rate_warning(rig), "") << "an older rig does not say";
}

TEST(RigStatus, ReportsWhyARigIsNotConnected) {
    RigStatus rig = good_rig();
    rig.connected = false;
    EXPECT_EQ(trouble_of(rig), "tcp://north:5600 is silent");
    rig.unreachable = "the name north does not resolve";
    EXPECT_EQ(trouble_of(rig), "the name north does not resolve");
    rig.refused = "no more hosts";
    EXPECT_EQ(trouble_of(rig), "no more hosts");
}

TEST(RigStatus, ReportsWhyAConnectedRigContributesNothing) {
    RigStatus rig = good_rig();
    rig.is_out_of_step = true;
    EXPECT_THAT(trouble_of(rig), HasSubstr("counts pulses differently"));
    rig = good_rig();
    rig.lags = true;
    EXPECT_THAT(trouble_of(rig), HasSubstr("after the latency budget"));
    rig = good_rig();
    rig.unsynchronized = 5;
    EXPECT_THAT(trouble_of(rig), HasSubstr("no trigger pulse"));
    rig.in_frame_sets = 100;
    EXPECT_EQ(trouble_of(rig), "") << "some pictures do";
    rig.names_no_pulse = true;
    EXPECT_THAT(trouble_of(rig), HasSubstr("no trigger pulse"));
}

TEST(RigStatus, AFaultyRigContributesNoFrames) {
    const RigStatus good = good_rig();
    EXPECT_TRUE(gives_pictures(good, {good}));
    RigStatus rig = good;
    rig.connected = false;
    EXPECT_FALSE(gives_pictures(rig, {rig, good}));
    rig = good;
    rig.is_out_of_step = true;
    EXPECT_FALSE(gives_pictures(rig, {rig, good}));
    rig = good;
    rig.lags = true;
    EXPECT_FALSE(gives_pictures(rig, {rig, good}));
}

TEST(RigStatus, ARigAtAnotherRateContributesIfNoneIsAtTheStagesRate) {
    RigStatus other = good_rig();
    other.sync.rate_hz = 5;
    EXPECT_TRUE(gives_pictures(other, {other, other}));
    RigStatus good = good_rig();
    EXPECT_TRUE(gives_pictures(other, {other, good})) << "it is connected and films nothing";
    good.health.published_hz = 25;
    EXPECT_FALSE(gives_pictures(other, {other, good}));
    EXPECT_TRUE(gives_pictures(good, {other, good}));
    other.is_out_of_step = true;
    EXPECT_FALSE(gives_pictures(other, {other, other})) << "not even with the other rigs";
}

}  // namespace
}  // namespace vantage
