#include "host_app/live/live_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

RigStatus good_rig() {
    RigStatus rig;
    rig.rig = "north";
    rig.connected = true;
    rig.sync.disciplined = true;
    rig.sync.ptp_state = "SLAVE";
    rig.health.temperature_c = 55.0f;
    return rig;
}

TEST(LiveReport, AGoodRigGivesNoWorry) {
    EXPECT_THAT(worries_of(good_rig()), IsEmpty());
    RigStatus here = good_rig();
    here.sync.disciplined = false;
    here.same_clock = true;
    here.health.temperature_c.reset();
    EXPECT_THAT(worries_of(here), IsEmpty());
}

TEST(LiveReport, TellsOfHeatSupplyAndClocks) {
    RigStatus rig = good_rig();
    rig.health.temperature_c = 82.6f;
    rig.health.under_voltage = true;
    rig.sync.disciplined = false;
    EXPECT_THAT(worries_of(rig), ElementsAre(HasSubstr("83 C"), HasSubstr("supply"),
                                             "clocks not disciplined: skew unknown"));
    LiveReport report;
    report.rigs.push_back({.status = rig});
    EXPECT_THAT(to_text(report), HasSubstr("north: its supply sags"));
    EXPECT_EQ(to_json(report)["rigs"][0]["health"]["under_voltage"], true);
    rig.connected = false;
    EXPECT_THAT(worries_of(rig), IsEmpty()) << "what it said last may not hold any more";
}

}  // namespace
}  // namespace vantage
