#include <gtest/gtest.h>

#include "host_app/session/options/show_options.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

// tests/previous_version has files that the version before wrote; they are never written anew.

std::string previous(const char* name) {
    return (source_folder() / "tests/previous_version" / name).string();
}

TEST(PreviousVersion, StageFilesLoad) {
    const StageConfig stage = load_stage_config(previous("stage.toml"));
    EXPECT_EQ(stage.rigs.size(), 2u);
    EXPECT_EQ(stage.rate_hz, 25);
    EXPECT_EQ(stage.timecode_zone, "Europe/Stockholm");
    EXPECT_EQ(stage.view.synthesiser, "fused");
}

TEST(PreviousVersion, DesksFlightsAndClipsLoadBesideTheStage) {
    const ShowOptions options;
    const std::string stage = previous("stage.toml");
    const std::optional<DeskStore> desk = options.desk_store(stage);
    ASSERT_TRUE(desk);
    EXPECT_TRUE(desk->desk().switches.rigs_apart);
    EXPECT_NEAR(desk->desk().switches.eye.nearness, 0.25, 1e-9);
    EXPECT_EQ(desk->desk().window.value_or(WindowPlace{}).width, 1600);

    const FlightStore flights = options.flight_store(stage);
    ASSERT_TRUE(flights.book().move);
    EXPECT_EQ(flights.book().move->duration_s(), 6);
    ASSERT_TRUE(flights.book().shots[3]);
    EXPECT_EQ(flights.book().shots[3]->name, "close");

    const ClipStore clips = options.clip_store(stage, 25);
    EXPECT_EQ(clips.book().clips.at(2).name, "the leap");
    EXPECT_EQ(clips.book().list.size(), 1u);
}

TEST(PreviousVersion, BackgroundsLoad) {
    ShowOptions options;
    options.background = previous("background.vset");
    const LiveSettings settings = options.settings({}, 25);
    ASSERT_TRUE(settings.background);
    EXPECT_FALSE(settings.background->rigs.empty());
}

}  // namespace
}  // namespace vantage
