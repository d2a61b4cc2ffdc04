#include "common/sync/sync_file.h"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::HasSubstr;

SyncRecord example() {
    return {.date = "2026-11-23T16:00:00Z",
            .tool = "test",
            .rate_hz = 29.97,
            .bar_step_ms = 0.1,
            .reference = "A left",
            .sensors = {{"A", true, 0, 0, 5.01, 24, 0, 0},
                        {"A", false, -0.04, 0.01, 5.02, 24, 0, 0},
                        {"B", true, 33.4, 0.02, 5, 20, 4, 1}}};
}

TEST(SyncFile, keeps_a_proof_beside_the_stage) {
    const TemporaryFolder folder;
    const std::filesystem::path file = sync_file_of(folder.path() / "stage.toml");
    EXPECT_EQ(file, folder.path() / "stage.sync.yaml");
    save_sync(file, example());
    const SyncRecord read = load_sync(file);
    EXPECT_EQ(read.date, "2026-11-23T16:00:00Z");
    ASSERT_EQ(read.sensors.size(), 3u);
    EXPECT_EQ(read.sensors[2].name(), "B left");
    EXPECT_EQ(read.sensors[2].strays, 4);
    EXPECT_EQ(read.sensors[2].pulses_apart, 1);
    EXPECT_DOUBLE_EQ(read.sensors[1].skew_ms, -0.04);
    EXPECT_DOUBLE_EQ(read.worst_ms(), 33.44);
}

TEST(SyncFile, refuses_numbers_that_somebody_changed) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "stage.sync.yaml";
    save_sync(file, example());
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    std::string changed = text.str();
    const std::size_t at = changed.find("pulses_apart: 1");
    ASSERT_NE(at, std::string::npos);
    changed.replace(at, 15, "pulses_apart: 0");
    std::ofstream(file) << changed;
    EXPECT_THAT(thrown_sentence([&] { load_sync(file); }), HasSubstr("checksum"));
}

}  // namespace
}  // namespace vantage
