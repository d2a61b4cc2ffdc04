#include "host_app/session/report/rig_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

using testing::HasSubstr;

RigStatus quiet_rig() {
    RigStatus rig;
    rig.rig = "north";
    rig.connected = true;
    return rig;
}

TEST(RigSilence, IsThatOfARigWhoseCamerasDeliverNothing) {
    const RigStatus rig = quiet_rig();
    EXPECT_FALSE(delivers(rig, {rig}));
    EXPECT_THAT(silence_of(rig), HasSubstr("its cameras deliver nothing"));
}

TEST(RigSilence, TellsAHungRigFromOneWithoutCameras) {
    RigStatus rig = quiet_rig();
    rig.health.captured_hz = 25;
    EXPECT_THAT(silence_of(rig), HasSubstr("captures, but sends nothing"));
    // One that was armed and has had its first pulse is no longer excused.
    rig.sync.role = RigSync::Role::follow;
    rig.sync.ready = true;
    rig.sync.first_pulse = 7;
    EXPECT_FALSE(waits_for_a_host(rig));
    EXPECT_THAT(silence_of(rig), HasSubstr("captures, but sends nothing"));
}

TEST(RigSilence, OfAnArmedRigSaysThatAHostHasToStart) {
    RigStatus rig = quiet_rig();
    rig.sync.role = RigSync::Role::lead;
    rig.sync.ready = true;
    EXPECT_TRUE(waits_for_a_host(rig));
    EXPECT_THAT(silence_of(rig), HasSubstr("vantage live"));
}

TEST(RigSilence, IsNotOfARigThatSendsOrHasAnotherTrouble) {
    RigStatus rig = quiet_rig();
    rig.health.published_hz = 5;
    EXPECT_TRUE(delivers(rig, {rig}));
    EXPECT_EQ(silence_of(rig), "");
    rig = quiet_rig();
    rig.connected = false;
    EXPECT_EQ(silence_of(rig), "") << "the reason is that it is not reached";
}

}  // namespace
}  // namespace vantage
