#include "host_app/session/sync_proof.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"

namespace vantage {
namespace {

TEST(SyncProof, DescribesAgeAndSkewOfTheLastMeasurement) {
    const TemporaryFolder folder;
    const std::filesystem::path stage = folder.path() / "stage.toml";
    const auto now = std::chrono::sys_days(std::chrono::year(2026) / 11 / 23);
    EXPECT_EQ(sync_words(sync_proof_of(stage), now), "not measured (run vantage-calib sync)");
    EXPECT_TRUE(is_doubtful(sync_proof_of(stage), now));
    EXPECT_TRUE(to_json(sync_proof_of(stage), now).is_null());

    SyncRecord record{.date = "2026-11-20T09:00:00Z",
                      .tool = "test",
                      .rate_hz = 30,
                      .bar_step_ms = 0.127,
                      .reference = "A left",
                      .sensors = {{"A", true, 0, 0, 5, 24, 0, 0},
                                  {"A", false, 0.04, 0.01, 5, 24, 0, 0},
                                  {"B", true, -0.12, 0.01, 5, 24, 0, 0}}};
    save_sync(sync_file_of(stage), record);
    EXPECT_EQ(sync_words(sync_proof_of(stage), now), "measured 3 d ago, 0.16 ms");
    EXPECT_FALSE(is_doubtful(sync_proof_of(stage), now));
    EXPECT_TRUE(is_doubtful(sync_proof_of(stage), now + std::chrono::days(40)));
    EXPECT_EQ(to_json(sync_proof_of(stage), now)["furthest"]["sensor"], "B left");

    record.sensors[2].strays = 3;
    save_sync(sync_file_of(stage), record);
    EXPECT_TRUE(is_doubtful(sync_proof_of(stage), now));
    std::ofstream(sync_file_of(stage)) << "kind: another\n";
    EXPECT_NE(sync_words(sync_proof_of(stage), now).find("the measurement cannot be read: "),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
