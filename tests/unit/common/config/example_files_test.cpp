#include <fstream>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "common/config/rig_config.h"
#include "common/config/stage_config.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

/// The keys that a loader knows in a table, from what it says of one that it does not know.
std::vector<std::string> known_keys(const std::string& sentence) {
    const std::string list_starts = "the ones there are: ";
    const std::size_t at = sentence.find(list_starts);
    std::vector<std::string> keys;
    std::istringstream list(at == std::string::npos ? ""
                                                    : sentence.substr(at + list_starts.size()));
    for (std::string key; list >> key;) keys.push_back(key.substr(0, key.find(',')));
    return keys;
}

/// Keys of a table that the example has neither set nor shown behind a '#'.
std::vector<std::string> undocumented(const std::filesystem::path& example,
                                      const std::vector<std::string>& keys) {
    std::ostringstream text;
    text << std::ifstream(example).rdbuf();
    const std::string content = text.str();
    std::vector<std::string> missing;
    for (const std::string& key : keys)
        if (!std::regex_search(
                content, std::regex("(^|\n)(# )?(\\[|\\[\\[|\\[source\\.)?" + key + "(\\]| = )")))
            missing.push_back(key);
    return missing;
}

TEST(ExampleFiles, RigsOfRealBoardsLoad) {
    const auto folder = source_folder() / "hw_config/rigs";
    for (const char* board : {"pi4.toml", "pi5.toml", "cm5.toml"}) {
        const RigConfig rig = load_rig_config(folder / board);
        EXPECT_EQ(rig.source.kind, "libcamera") << board;
        EXPECT_EQ(rig.match.preset, "auto") << board;
        EXPECT_FALSE(rig.stream.key_file.empty()) << board << " listens beyond loopback";
    }
}

TEST(ExampleFiles, LoadAndShowTheDefaults) {
    const RigConfig rig = load_rig_config(source_folder() / "hw_config/rig.toml");
    const RigConfig defaults;
    EXPECT_EQ(rig.source.rate_hz, defaults.source.rate_hz);
    EXPECT_EQ(rig.source.width_px, defaults.source.width_px);
    EXPECT_EQ(rig.virtual_rig.distance_m, defaults.virtual_rig.distance_m);
    EXPECT_EQ(rig.virtual_rig.baseline_m, defaults.virtual_rig.baseline_m);
    EXPECT_EQ(rig.virtual_rig.scene, defaults.virtual_rig.scene);
    EXPECT_EQ(rig.trigger.role, defaults.trigger.role);
    EXPECT_EQ(rig.trigger.active_low, defaults.trigger.active_low);
    EXPECT_EQ(rig.trigger.start, defaults.trigger.start);
    EXPECT_EQ(rig.trigger.exposure_us, defaults.trigger.exposure_us);
    EXPECT_EQ(rig.trigger.late_limit_us, defaults.trigger.late_limit_us);
    EXPECT_EQ(rig.trigger.realtime_priority, defaults.trigger.realtime_priority);
    EXPECT_EQ(rig.match.disparities, defaults.match.disparities);
    EXPECT_EQ(rig.match.preset, defaults.match.preset);
    EXPECT_EQ(rig.stream.bind, defaults.stream.bind);
    EXPECT_EQ(rig.stream.jpeg_quality, defaults.stream.jpeg_quality);
    EXPECT_EQ(rig.stream.chroma, defaults.stream.chroma);
    EXPECT_EQ(rig.stream.queue_frames, defaults.stream.queue_frames);
    const StageConfig stage = load_stage_config(source_folder() / "hw_config/stage.toml");
    const StageConfig stage_defaults;
    EXPECT_EQ(stage.rigs.size(), 2u);
    EXPECT_EQ(stage.latency_budget_ms, stage_defaults.latency_budget_ms);
    EXPECT_EQ(stage.view.width_px, stage_defaults.view.width_px);
    EXPECT_EQ(stage.view.field_of_view_deg, stage_defaults.view.field_of_view_deg);
    EXPECT_EQ(stage.flight.holds_horizon, stage_defaults.flight.holds_horizon);
    EXPECT_EQ(stage.flight.smoothing_s, stage_defaults.flight.smoothing_s);
    EXPECT_EQ(stage.flight.ramp_s, stage_defaults.flight.ramp_s);
    EXPECT_EQ(stage.flight.max_turn_deg_s, stage_defaults.flight.max_turn_deg_s);
    EXPECT_EQ(stage.flight.max_zoom_deg_s, stage_defaults.flight.max_zoom_deg_s);
    EXPECT_EQ(stage.flight.max_speed_m_s, stage_defaults.flight.max_speed_m_s);
    EXPECT_EQ(stage.flight.shot_s, stage_defaults.flight.shot_s);
    EXPECT_EQ(stage.flight.keyframe_s, stage_defaults.flight.keyframe_s);
}

TEST(ExampleFiles, ShowEveryKeyThatIsRead) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "x.toml";
    const std::string unknown = "xxxxxxxxxxxxxxxx = 1\n";
    for (const char* table :
         {"", "[source]\n", "[trigger]\n", "[virtual_rig]\n", "[match]\n", "[stream]\n"}) {
        std::ofstream(file) << "version = 1\nname = 'a'\n" << table << unknown;
        const auto keys = known_keys(thrown_sentence([&] { load_rig_config(file); }));
        ASSERT_GE(keys.size(), 4u) << table;
        EXPECT_EQ(undocumented(source_folder() / "hw_config/rig.toml", keys),
                  std::vector<std::string>())
            << table;
    }
    for (const char* table : {"", "[[rigs]]\nname = 'a'\nendpoint = 'tcp://h:1'\n", "[view]\n",
                              "[timecode]\n", "[flight]\n"}) {
        std::ofstream(file) << "version = 1\n" << table << unknown;
        const auto keys = known_keys(thrown_sentence([&] { load_stage_config(file); }));
        ASSERT_GE(keys.size(), 1u) << table;
        EXPECT_EQ(undocumented(source_folder() / "hw_config/stage.toml", keys),
                  std::vector<std::string>())
            << table;
    }
}

}  // namespace
}  // namespace vantage
