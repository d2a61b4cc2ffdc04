#include <numbers>

#include <gtest/gtest.h>

#include "host_app/takes/take_show.h"
#include "tests/support/data_folder.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

class StageHabitsTest : public testing::Test {
  protected:
    /// As a take says whose stage's file was this.
    FlightHabits habits(const std::string& stage) const {
        TakeFacts facts = small_facts({"north"}, 100);
        const auto bytes = std::as_bytes(std::span(stage));
        facts.attachments.push_back(
            {stage_attachment, "application/toml", {bytes.begin(), bytes.end()}});
        const std::filesystem::path file = folder_.path() / "take.mkv";
        std::filesystem::remove(file);
        TakeWriter(file, facts).finish();
        return habits_of(TakeReader(file));
    }

    TemporaryFolder folder_;
};

TEST_F(StageHabitsTest, ReadsTheFlightSettingsOfATake) {
    const FlightHabits flown = habits(
        "version = 1\nkey_file = \"not/at/hand\"\n[[rigs]]\nname = \"north\"\npublic_key_file = "
        "\"neither\"\n[flight]\nhorizon = false\nmax_turn_deg_s = 90\nmax_speed_m_s = 2.5\nramp_s "
        "= 0.4\nsmoothing_s = 0.3\nshot_s = 4\nkeyframe_s = 7\n");
    EXPECT_FALSE(flown.holds_horizon);
    EXPECT_NEAR(flown.max_turn_rad_s, std::numbers::pi / 2, 1e-12);
    EXPECT_EQ(flown.max_speed_m_s, 2.5);
    EXPECT_EQ(flown.ramp_s, 0.4);
    EXPECT_EQ(flown.follow_s, 0.3);
    EXPECT_EQ(flown.shot_s, 4);
    EXPECT_EQ(flown.keyframe_gap_s, 7);
}

TEST_F(StageHabitsTest, UsesDefaultsForAnUnreadableStageFile) {
    for (const char* stage : {"", "no TOML [", "version = 1\n[flight]\nramp_s = -1\n",
                              "version = 1\n[flight]\nsideways = 3\n", "version = 7\n"})
        EXPECT_EQ(habits(stage).ramp_s, FlightHabits().ramp_s) << stage;
    TakeWriter(folder_.path() / "bare.mkv", small_facts({"north"}, 100)).finish();
    EXPECT_EQ(habits_of(TakeReader(folder_.path() / "bare.mkv")).shot_s, FlightHabits().shot_s);
}

}  // namespace
}  // namespace vantage
