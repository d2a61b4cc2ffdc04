#include "host_app/session/report/live_report.h"

#include <regex>

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

TEST(LiveReport, AGoodRigHasNoWorries) {
    EXPECT_THAT(worries_of(good_rig()), IsEmpty());
    RigStatus here = good_rig();
    here.sync.disciplined = false;
    here.same_clock = true;
    here.health.temperature_c.reset();
    EXPECT_THAT(worries_of(here), IsEmpty());
}

TEST(LiveReport, ReportsHeatSupplyAndClocks) {
    RigStatus rig = good_rig();
    rig.health.temperature_c = 82.6f;
    rig.health.under_voltage = true;
    rig.sync.disciplined = false;
    EXPECT_THAT(worries_of(rig), ElementsAre(HasSubstr("83 C"), HasSubstr("supply"),
                                             "clocks not disciplined: skew unknown"));
    LiveReport report;
    report.rigs.push_back({.status = rig});
    EXPECT_THAT(to_text(report), HasSubstr("north: the supply voltage is too low"));
    EXPECT_EQ(to_json(report)["rigs"][0]["health"]["under_voltage"], true);
    rig.connected = false;
    EXPECT_THAT(worries_of(rig), IsEmpty()) << "its last report may no longer hold";
}

TEST(LiveReport, SaysWhyFramesDoNotComeOverSrt) {
    RigStatus rig = good_rig();
    rig.datagram_trouble = "SRT cannot connect to UDP port 5600";
    const std::string sentence =
        "its frames come over TCP because SRT cannot connect to UDP port 5600";
    EXPECT_THAT(worries_of(rig), ElementsAre(sentence));
    LiveReport report;
    report.rigs.push_back({.status = rig});
    EXPECT_THAT(to_text(report), HasSubstr("north: " + sentence));
    EXPECT_EQ(to_json(report)["rigs"][0]["road"], "tcp");
    EXPECT_EQ(to_json(report)["rigs"][0]["road_trouble"], rig.datagram_trouble);
    rig.connected = false;
    EXPECT_THAT(worries_of(rig), IsEmpty());
}

TEST(LiveReport, ReportsARigAtAnotherRateThanTheStage) {
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

TEST(LiveReport, ReportsWhyARigIsDisconnectedAndItsOutages) {
    RigStatus rig = good_rig();
    EXPECT_EQ(full_state_of(rig), "connected");
    EXPECT_EQ(outages_of(rig), "");
    rig.connected = false;
    rig.unreachable = "connection refused";
    rig.outages = 1;
    rig.outage_s = 9.25;
    EXPECT_EQ(outages_of(rig), "was disconnected once, 9.2 s in all");
    rig.outages = rig.restarts = 2;
    EXPECT_EQ(outages_of(rig),
              "was disconnected 2 times, 9.2 s in all; its daemon restarted 2 times");
    rig.outages = 1;
    rig.restarts = 0;
    EXPECT_EQ(state_of(rig), "disconnected");
    EXPECT_EQ(full_state_of(rig), "disconnected: connection refused");
    LiveReport report;
    report.rigs.push_back({.status = rig});
    const std::string text = to_text(report);
    EXPECT_THAT(text, HasSubstr("north is disconnected: connection refused\n"));
    EXPECT_THAT(text, HasSubstr("north: was disconnected once, 9.2 s in all"));
    EXPECT_EQ(to_json(report)["rigs"][0]["outages"]["total_s"], 9.25);
}

TEST(LiveReport, SaysThatAnOutputWasNotStarted) {
    LiveReport report;
    OutputState later, now;
    later.name = "film later.mkv?start=off";
    now.name = "film now.mkv";
    now.offered = now.pictures = 2;
    report.outputs = {later, now};
    const std::string text = to_text(report);
    EXPECT_THAT(text, HasSubstr("output: film later.mkv?start=off was not started\n"));
    EXPECT_THAT(text, HasSubstr("output: film now.mkv, 2 frames"));
}

TEST(LiveReport, ExplainsEveryHeadingOfItsTables) {
    LiveReport report;
    report.rigs.push_back({.status = good_rig()});
    const std::string text = to_text(report);
    const std::string legend = counters_legend();
    EXPECT_THAT(text, HasSubstr(legend));
    const std::string words = std::regex_replace(legend, std::regex("\\s+"), " ");
    for (const char* heading :
         {"missed", "late", "published", "skipped", "dropped at rig", "sent", "lost", "damaged",
          "dropped at host", "duplicate", "unsynchronised", "out of step", "in frame sets", "fused",
          "replaced by newer", "dropped at start"}) {
        EXPECT_THAT(words, HasSubstr(heading));
        EXPECT_THAT(text.substr(0, text.find(legend)), HasSubstr(heading));
    }
}

TEST(LiveReport, KeepsRenamedKeysForOneRelease) {
    LiveReport report;
    report.programme.pictures = 30;
    report.programme.duration_s = 2;
    report.programme.replaced = 4;  // old name
    report.frame_sets_replaced = 3;
    report.saved_background = "studio.vset";
    report.source_map.emplace();
    RigAccount rig{.status = good_rig(), .fused = 5, .replaced = 7};
    rig.status.in_frame_sets = 12;
    rig.background.emplace().known = 0.5;
    report.rigs.push_back(rig);
    const nlohmann::ordered_json json = to_json(report);
    const std::pair<const char*, const char*> keys[] = {
        {"/new_frames_per_second", "/pictures_a_second"},
        {"/replaced_pictures", "/superseded_pictures"},   // old name
        {"/input_to_picture_ms", "/hand_to_picture_ms"},  // old name
        {"/idle_to_best_ms", "/rest_to_best_ms"},
        {"/frame_sets/replaced", "/sets/superseded"},  // old name
        {"/instants/per_second", "/instants/a_second"},
        {"/source_map", "/novelty"},  // old name
        {"/saved_background", "/saved_set"},
        {"/rigs/0/background/known", "/rigs/0/set/known"},
        {"/rigs/0/link/skipped", "/rigs/0/link/thinned"},  // old name
        {"/rigs/0/host/in_frame_sets", "/rigs/0/host/in_sets"},
        {"/rigs/0/host/replaced", "/rigs/0/host/superseded"},  // old name
        {"/rigs/0/host/dropped_at_start", "/rigs/0/host/in_dropped_sets"}};
    for (const auto& [key, old_key] : keys)
        EXPECT_EQ(json.at(nlohmann::ordered_json::json_pointer(key)),
                  json.at(nlohmann::ordered_json::json_pointer(old_key)))
            << key;
    EXPECT_EQ(json["new_frames_per_second"], 15);
    EXPECT_EQ(json["rigs"][0]["host"]["replaced"], 7);
}

TEST(LiveReport, ReportsTheSignalAtTheEnd) {
    LiveReport report;
    report.signal = SignalState::stale;
    EXPECT_EQ(to_json(report)["signal"], "stale");
    EXPECT_THAT(to_text(report), HasSubstr("signal at the end: STALE\n"));
}

}  // namespace

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
