#include "host_app/session/report/live_report.h"

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

TEST(LiveReport, NamesARigAtAnotherRateWithBoth) {
    RigStatus rig = good_rig();
    rig.sync.rate_hz = 2;
    rig.stage_rate_hz = 25;
    EXPECT_THAT(worries_of(rig), ElementsAre(HasSubstr("2 Hz and the stage at 25 Hz")));
    EXPECT_THAT(full_state_of(rig), HasSubstr("connected: it runs at 2 Hz"));
    LiveReport report;
    report.rigs.push_back({.status = rig});
    EXPECT_THAT(to_text(report), HasSubstr("north: it runs at 2 Hz"));
    EXPECT_THAT(std::string(to_json(report)["rigs"][0]["trouble"]), HasSubstr("2 Hz"));
}

TEST(LiveReport, SaysWhyARigIsAwayAndForHowLongItWas) {
    RigStatus rig = good_rig();
    EXPECT_EQ(full_state_of(rig), "connected");
    EXPECT_EQ(outages_of(rig), "");
    rig.connected = false;
    rig.unreachable = "connection refused";
    rig.outages = 1;
    rig.outage_s = 9.25;
    EXPECT_EQ(outages_of(rig), "was away once, 9.2 s in all");
    rig.outages = rig.restarts = 2;
    EXPECT_EQ(outages_of(rig),
              "was away 2 times, 9.2 s in all; its daemon was started anew 2 times");
    rig.outages = 1;
    rig.restarts = 0;
    EXPECT_EQ(state_of(rig), "disconnected");
    EXPECT_EQ(full_state_of(rig), "disconnected: connection refused");
    LiveReport report;
    report.rigs.push_back({.status = rig});
    const std::string text = to_text(report);
    EXPECT_THAT(text, HasSubstr("north is disconnected: connection refused\n"));
    EXPECT_THAT(text, HasSubstr("north: was away once, 9.2 s in all"));
    EXPECT_EQ(to_json(report)["rigs"][0]["outages"]["total_s"], 9.25);
}

TEST(LiveReport, ExplainsEveryHeadingOfItsTables) {
    LiveReport report;
    report.rigs.push_back({.status = good_rig()});
    const std::string text = to_text(report);
    const std::string legend = counters_legend();
    EXPECT_THAT(text, HasSubstr(legend));
    for (const char* heading : {"missed", "late", "published", "thinned", "pushed out", "sent",
                                "lost", "damaged", "host busy", "duplicate", "unsynced",
                                "out of step", "in sets", "fused", "superseded", "set dropped"}) {
        EXPECT_THAT(legend, HasSubstr(heading));
        EXPECT_THAT(text.substr(0, text.find(legend)), HasSubstr(heading));
    }
}

TEST(LiveReport, TellsWhatThePictureWasAtTheEnd) {
    LiveReport report;
    report.signal = SignalState::stale;
    EXPECT_EQ(to_json(report)["signal"], "stale");
    EXPECT_THAT(to_text(report), HasSubstr("signal at the end: STALE\n"));
}

}  // namespace
}  // namespace vantage
