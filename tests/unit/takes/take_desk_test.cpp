#include "host_app/takes/take_desk.h"

#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"

namespace vantage {
namespace {

TEST(TakeDeskTest, WhileATakeRunsAllRigsSendAndOnlyThoseThatAreNeededAreLookedAt) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "stage.toml";
    std::ofstream(file) << "version = 1\n";
    StageConfig stage;
    stage.rigs.push_back({"a", "tcp://127.0.0.1:5600", ""});
    stage.rigs.push_back({"b", "tcp://127.0.0.1:5601", ""});
    TakeDesk takes(stage, file, folder.path() / "take.mkv", folder.path(),
                   std::chrono::nanoseconds(0));
    std::map<std::string, bool> sends{{"a", true}, {"b", true}}, is_looked_at = sends;
    StageFeed feed;
    feed.status = [] {
        ReceiverStatus status;
        status.rigs.resize(2);
        status.rigs[0].rig = "a";
        status.rigs[1].rig = "b";
        return status;
    };
    feed.ask = [&](const std::string& rig, bool streaming) { sends[rig] = streaming; };
    feed.look_at = [&](const std::string& rig, bool looked) { is_looked_at[rig] = looked; };
    feed = takes.feed(std::move(feed));
    feed.ask("b", false);
    EXPECT_FALSE(sends["b"]);
    EXPECT_FALSE(is_looked_at["b"]);
    takes.begin(folder.path() / "take.mkv");
    EXPECT_TRUE(sends["a"] && sends["b"]) << "all are recorded";
    EXPECT_TRUE(is_looked_at["a"]);
    EXPECT_FALSE(is_looked_at["b"]);
    feed.ask("b", true);
    EXPECT_TRUE(is_looked_at["b"]) << "the camera comes round";
}

}  // namespace
}  // namespace vantage
