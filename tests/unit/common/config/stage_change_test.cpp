#include "common/config/stage_change.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

StageConfig stage_of(const std::vector<std::string>& rigs) {
    StageConfig stage;
    for (const std::string& rig : rigs)
        stage.rigs.push_back({rig, "tcp://" + rig + ":5600", "key of " + rig, ""});
    return stage;
}

TEST(StageChange, OfTheSameStageIsNothing) {
    const StageConfig stage = stage_of({"north", "south"});
    EXPECT_EQ(text_of(stage_change(stage, stage), false),
              "nothing that a running show can follow changed");
}

TEST(StageChange, NamesRigsThatComeAndGo) {
    const StageChange change =
        stage_change(stage_of({"north", "south", "east"}), stage_of({"west", "south", "up"}));
    EXPECT_THAT(change.added, ElementsAre("west", "up"));
    EXPECT_THAT(change.removed, ElementsAre("north", "east"));
    EXPECT_FALSE(change.has_new_order);
    EXPECT_EQ(text_of(change, false), "added rigs west, up; removed rigs north, east");
}

TEST(StageChange, NamesRigsThatAreReachedInAnotherWay) {
    const StageConfig running = stage_of({"north", "south", "east"});
    StageConfig file = running;
    file.rigs[0].endpoint = "tcp://north:5601";
    file.rigs[1].public_key = "another key";
    file.rigs[2].colour = "east.colour.toml";
    file.latency_budget_ms = 100;
    const StageChange change = stage_change(running, file);
    EXPECT_THAT(change.moved, ElementsAre("north"));
    EXPECT_THAT(change.rekeyed, ElementsAre("south"));
    EXPECT_THAT(change.recoloured, ElementsAre("east"));
    EXPECT_TRUE(change.has_new_latency_budget);
    EXPECT_THAT(change.added, IsEmpty());
    EXPECT_THAT(change.left, IsEmpty());
    EXPECT_EQ(text_of(change, true),
              "another endpoint for rig north; another public key for rig south; another colour "
              "file for rig east; another key of this host; another latency budget");
}

TEST(StageChange, NoticesAnotherOrderOfTheRigsThatStay) {
    EXPECT_TRUE(stage_change(stage_of({"north", "south"}), stage_of({"west", "south", "north"}))
                    .has_new_order);
}

TEST(StageChange, NamesAndLeavesWhatNeedsAStart) {
    const StageConfig running = stage_of({"north"});
    StageConfig file = stage_of({"north", "south"});
    file.rate_hz = 50;
    file.timecode_zone = "Europe/Stockholm";
    file.view.width_px = 1920;
    file.view.target_m[1] = 2;
    file.flight.max_speed_m_s = 3;
    file.latency_budget_ms = 100;
    const StageChange change = stage_change(running, file);
    EXPECT_THAT(change.left, ElementsAre("rate_hz", "timecode.zone", "view.width_px",
                                         "view.target_m", "flight.max_speed_m_s"));
    EXPECT_EQ(text_of(change, false),
              "added rig south; another latency budget; not applied until the next start: rate_hz, "
              "timecode.zone, view.width_px, view.target_m, flight.max_speed_m_s");
    const StageConfig stage = stage_to_go_on_with(running, file);
    EXPECT_EQ(stage.rigs.size(), 2u);
    EXPECT_EQ(stage.latency_budget_ms, 100);
    EXPECT_EQ(stage.rate_hz, running.rate_hz);
    EXPECT_EQ(stage.view.width_px, running.view.width_px);
    EXPECT_THAT(stage_change(running, stage).left, IsEmpty());
    EXPECT_EQ(stage_change(stage, file).left.size(), 5u) << "and the next reload names them again";
}

}  // namespace
}  // namespace vantage
