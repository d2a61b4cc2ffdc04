#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

/// Shows of a take, each a process, that save what they learn of its set and begin with it.
class Sets : public testing::Test {
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

TEST_F(Sets, AreSavedAtTheEndAndBegunWith) {
    const ProgramResult first = play({"--save-set", at("studio.vset")});
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(nlohmann::json::parse(first.out)["saved_set"], at("studio.vset"));
    ASSERT_TRUE(std::filesystem::exists(at("studio.vset")));
    for (const auto& rig : nlohmann::json::parse(first.out)["rigs"])
        EXPECT_FALSE(rig["set"]["loaded"].get<bool>());

    const ProgramResult second = play({"--set", at("studio.vset")});
    ASSERT_EQ(second.status, 0) << second.err;
    for (const auto& rig : nlohmann::json::parse(second.out)["rigs"]) {
        EXPECT_TRUE(rig["set"]["loaded"].get<bool>()) << rig["set"];
        EXPECT_FALSE(rig["set"].contains("misfit")) << rig["set"];
    }

    const ProgramResult again = play({"--save-set", at("studio.vset")});
    EXPECT_EQ(again.status, 1);
    EXPECT_NE(again.err.find("there is such a file"), std::string::npos) << again.err;
    const ProgramResult none = play({"--set", (source_folder() / "README.md").string()});
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("no learnt set"), std::string::npos) << none.err;
}

TEST_F(Sets, AreSavedWhileAShowRunsByACommandThatADeskSees) {
    const auto [port, lamps] = two_free_ports();
    ChildProgram watcher("/usr/bin/stdbuf", {"-oL", "oscdump", std::to_string(lamps)},
                         folder_.path());
    ChildProgram show(
        VANTAGE_PROGRAM,
        played({"--loop", "--seconds", "300", "--save-set", at("by_hand.vset"), "--control",
                fmt::format("osc://:{}?lamps=127.0.0.1:{}", port, lamps)}),
        folder_.path());
    const auto is_told = [&](const std::string& words) {
        for (int i = 0; i < 3000; ++i) {
            if (watcher.out().find(words) != std::string::npos) return true;
            usleep(20'000);
        }
        return false;
    };
    const auto oscsend = [&](const std::string& words) {
        return std::system(fmt::format("oscsend 127.0.0.1 {} {}", port, words).c_str()) == 0;
    };
    ASSERT_TRUE(is_told("lamp/speed f 1.0")) << watcher.out() << show.err();
    ASSERT_TRUE(oscsend("/vantage/save_set"));
    EXPECT_TRUE(is_told("by_hand.vset")) << watcher.out() << show.err();
    ASSERT_TRUE(oscsend("/vantage/learn_set"));
    show.send_signal(SIGINT);
    const ProgramResult end = show.wait();
    EXPECT_EQ(nlohmann::json::parse(end.out)["saved_set"], at("by_hand.vset"));
    EXPECT_TRUE(std::filesystem::exists(at("by_hand.vset")));
    EXPECT_FALSE(std::filesystem::exists(at("by_hand-2.vset")));
}

}  // namespace
}  // namespace vantage
