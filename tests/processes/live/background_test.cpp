#include <csignal>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/processes/live/steered_show.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

/// Shows of a take, each a process, that save their background and start with a saved one.
class SavedBackgrounds : public testing::Test {
  protected:
    std::vector<std::string> played(std::vector<std::string> more) const {
        std::vector<std::string> words{
            "play",    (source_folder() / "tests/takes/version_1.mkv").string(),
            "--json",  "--headless",
            "--size",  "96x72",
            "--synth", "fused"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    ProgramResult play(std::vector<std::string> more) const {
        return ChildProgram(VANTAGE_PROGRAM, played(std::move(more)), folder_.path()).wait();
    }

    std::string at(const char* name) const { return (folder_.path() / name).string(); }

    TemporaryFolder folder_;
};

TEST_F(SavedBackgrounds, AreWrittenAtTheEndAndLoadedAtTheStart) {
    const ProgramResult first = play({"--save-background", at("studio.vset")});
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(nlohmann::json::parse(first.out)["saved_background"], at("studio.vset"));
    ASSERT_TRUE(std::filesystem::exists(at("studio.vset")));
    for (const auto& rig : nlohmann::json::parse(first.out)["rigs"])
        EXPECT_FALSE(rig["background"]["loaded"].get<bool>());

    const ProgramResult second = play({"--background", at("studio.vset")});
    ASSERT_EQ(second.status, 0) << second.err;
    for (const auto& rig : nlohmann::json::parse(second.out)["rigs"]) {
        EXPECT_TRUE(rig["background"]["loaded"].get<bool>()) << rig["background"];
        EXPECT_FALSE(rig["background"].contains("misfit")) << rig["background"];
    }

    const ProgramResult again = play({"--save-background", at("studio.vset")});
    EXPECT_EQ(again.status, 1);
    EXPECT_NE(again.err.find("the file exists"), std::string::npos) << again.err;
    const ProgramResult none = play({"--background", (source_folder() / "README.md").string()});
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("not a background file"), std::string::npos) << none.err;
}

/// Renamed options keep their old names for one release.
TEST_F(SavedBackgrounds, AreSavedAndLoadedUnderTheOldNamesOfTheOptions) {
    const ProgramResult first =
        play({"--save-set", at("studio.vset"), "--no-harmonise",  // old name
              "--novelty"});                                      // old name
    ASSERT_EQ(first.status, 0) << first.err;
    for (const char* warning : {"--save-set is the old name of --save-background",
                                "--no-harmonise is the old name of",  // old name
                                "--novelty is the old name of --source-map"})
        EXPECT_NE(first.err.find(warning), std::string::npos) << first.err;
    const nlohmann::json summary = nlohmann::json::parse(first.out);
    EXPECT_EQ(summary["saved_background"], at("studio.vset"));
    EXPECT_TRUE(summary.contains("source_map"));
    for (const auto& rig : summary["rigs"]) EXPECT_FALSE(rig.contains("colour")) << rig;

    const ProgramResult second = play({"--set", at("studio.vset")});
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_NE(second.err.find("--set is the old name of --background"), std::string::npos)
        << second.err;
    for (const auto& rig : nlohmann::json::parse(second.out)["rigs"])
        EXPECT_TRUE(rig["background"]["loaded"].get<bool>()) << rig;
}

TEST_F(SavedBackgrounds, AreWrittenByACommandDuringTheShow) {
    SteeredShow steered(
        played({"--loop", "--seconds", "300", "--save-background", at("by_hand.vset")}), folder_);
    ASSERT_TRUE(steered.is_told("lamp/speed f 1.0")) << steered.told() << steered.show().err();
    ASSERT_TRUE(steered.send("/vantage/save_background"));
    EXPECT_TRUE(steered.is_told("by_hand.vset")) << steered.told() << steered.show().err();
    ASSERT_TRUE(steered.send("/vantage/learn_background"));
    steered.show().send_signal(SIGINT);
    const ProgramResult end = steered.show().wait();
    EXPECT_EQ(nlohmann::json::parse(end.out)["saved_background"], at("by_hand.vset"));
    EXPECT_TRUE(std::filesystem::exists(at("by_hand.vset")));
    EXPECT_FALSE(std::filesystem::exists(at("by_hand-2.vset")));
}

}  // namespace
}  // namespace vantage
