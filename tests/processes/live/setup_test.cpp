#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/files/atomic_file.h"
#include "common/config/stage_config.h"
#include "tests/processes/live/attended.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

struct SetupTest : testing::Test {
    TemporaryFolder folder;
    std::pair<int, int> streams = two_free_ports(), pairings = two_free_ports();
    std::filesystem::path stage = folder.path() / "host/stage.toml";

    std::string write_rig(const std::string& name, int port) const {
        std::filesystem::create_directories(folder.path() / name);
        const std::string file = (folder.path() / name / "rig.toml").string();
        write_text_atomically(
            file, fmt::format("version = 1\nname = \"{}\"\n[source]\nrate_hz = 20.0\n"
                              "width_px = 96\nheight_px = 72\n[match]\nmatcher = \"exact\"\n"
                              "[stream]\nbind = \"tcp://127.0.0.1:{}\"\n",
                              name, port));
        return file;
    }
    std::unique_ptr<Attended> open_rig(const std::string& name, const std::string& file, int port) {
        return std::make_unique<Attended>(
            VANTAGE_RIG_PROGRAM,
            fmt::format("pair --json --config '{}' --bind tcp://127.0.0.1:{}", file, port),
            folder.path(), name + "-pair");
    }
    std::unique_ptr<Attended> set_up(const std::string& options, const std::string& name) {
        return std::make_unique<Attended>(
            VANTAGE_PROGRAM, fmt::format("setup --json --stage '{}' {}", stage.string(), options),
            folder.path(), name);
    }
};

TEST_F(SetupTest, WritesAStageOfTwoRigsThatLiveCanShow) {
    const std::string north = write_rig("north", streams.first);
    const std::string south = write_rig("south", streams.second);
    const auto north_pair = open_rig("north", north, pairings.first);
    const auto south_pair = open_rig("south", south, pairings.second);
    north_pair->wait_for("open");
    south_pair->wait_for("open");
    const auto host = set_up(fmt::format("--rig 127.0.0.1:{} --rig 127.0.0.1:{} --wait 60",
                                         pairings.first, pairings.second),
                             "setup");
    compare_codes(*host, *north_pair, 0);
    EXPECT_EQ(north_pair->end().status, 0);
    compare_codes(*host, *south_pair, 1);
    EXPECT_EQ(south_pair->end().status, 0);
    // The daemons start with the files that pairing wrote, and setup waits for them.
    const ChildProgram north_runs(VANTAGE_RIG_PROGRAM, {"run", "--config", north},
                                  folder.path() / "north");
    const ChildProgram south_runs(VANTAGE_RIG_PROGRAM, {"run", "--config", south},
                                  folder.path() / "south");
    const ProgramResult result = host->end();
    EXPECT_EQ(result.status, 0) << result.err;
    const nlohmann::json checked = event_of(result.out, "checked");
    EXPECT_EQ(checked["ready"], true) << result.out;
    ASSERT_EQ(checked["rigs"].size(), 2u);
    EXPECT_EQ(checked["findings"].size(), 2u) << "virtual rigs have no calibration from a file";
    EXPECT_EQ(load_stage_config(stage).rate_hz, 20);

    const ProgramResult live =
        run_to_end(VANTAGE_PROGRAM, {"live", "--stage", stage.string(), "--headless", "--frames",
                                     "3", "--size", "96x72", "--json"});
    EXPECT_EQ(live.status, 0) << live.err;
    const nlohmann::json report = nlohmann::json::parse(live.out);
    ASSERT_EQ(report["rigs"].size(), 2u);
    for (const nlohmann::json& rig : report["rigs"]) EXPECT_EQ(rig["state"], "connected") << rig;
}

TEST_F(SetupTest, TrustsNoRigIfTheCodesDiffer) {
    const std::string north = write_rig("north", streams.first);
    const std::string before = read_text_file(north, 4096);
    const auto rig = open_rig("north", north, pairings.first);
    rig->wait_for("open");
    const auto host = set_up(fmt::format("--rig 127.0.0.1:{}", pairings.first), "setup");
    host->wait_for("code");
    rig->wait_for("code");
    host->type("000 00x");
    const ProgramResult result = host->end();
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("differ, so the rig is not trusted"), std::string::npos)
        << result.err;
    EXPECT_NE(rig->wait_for("failed")["why"].get<std::string>().find("host"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(stage));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "north/hosts.keys"));
    EXPECT_EQ(read_text_file(north, 4096), before);
}

TEST_F(SetupTest, ChangesAnExistingStageOnlyOnRequest) {
    std::filesystem::create_directories(stage.parent_path());
    const std::string before =
        "version = 1\n[[rigs]]\nname = \"a\"\nendpoint = \"tcp://127.0.0.1:1\"\n";
    write_text_atomically(stage, before);
    const auto rig = open_rig("north", write_rig("north", streams.first), pairings.first);
    rig->wait_for("open");
    const auto host = set_up(fmt::format("--rig 127.0.0.1:{}", pairings.first), "setup");
    const ProgramResult result = host->end();
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("use --add to add north to it"), std::string::npos) << result.err;
    EXPECT_EQ(read_text_file(stage, 4096), before);
}

}  // namespace
}  // namespace vantage
