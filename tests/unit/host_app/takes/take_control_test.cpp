#include "host_app/takes/take_control.h"

#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"

namespace vantage {
namespace {

/// Two rigs, and what is asked of them.
class TakeControlTest : public testing::Test {
  protected:
    TakeControlTest() {
        std::ofstream(file_) << "version = 1\n";
        stage_.rigs.push_back({"a", "tcp://127.0.0.1:5600", ""});
        stage_.rigs.push_back({"b", "tcp://127.0.0.1:5601", ""});
        feed_.status = [] {
            ReceiverStatus status;
            status.rigs.resize(2);
            status.rigs[0].rig = "a";
            status.rigs[1].rig = "b";
            return status;
        };
        feed_.ask = [this](const std::string& rig, bool streaming) { sends_[rig] = streaming; };
        feed_.look_at = [this](const std::string& rig, bool looked) {
            is_looked_at_[rig] = looked;
        };
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "stage.toml",
                          take_ = folder_.path() / "take.mkv";
    StageConfig stage_;
    StageFeed feed_;
    std::map<std::string, bool> sends_{{"a", true}, {"b", true}}, is_looked_at_ = sends_;
};

TEST_F(TakeControlTest, DuringATakeAllRigsSendAndOnlyNeededOnesAreDecoded) {
    TakeControl takes(stage_, file_, take_, folder_.path(), std::chrono::nanoseconds(0));
    const StageFeed feed = takes.feed(feed_);
    feed.ask("b", false);
    EXPECT_FALSE(sends_["b"]);
    EXPECT_FALSE(is_looked_at_["b"]);
    takes.begin(take_);
    EXPECT_TRUE(sends_["a"] && sends_["b"]) << "all are recorded";
    EXPECT_TRUE(is_looked_at_["a"]);
    EXPECT_FALSE(is_looked_at_["b"]);
    feed.ask("b", true);
    EXPECT_TRUE(is_looked_at_["b"]) << "the camera comes round";
}

TEST_F(TakeControlTest, AllRigsSendForAPreRoll) {
    TakeControl takes(stage_, file_, take_, folder_.path(), std::chrono::seconds(5));
    const StageFeed feed = takes.feed(feed_);
    feed.ask("b", false);
    EXPECT_TRUE(sends_["b"]);
    EXPECT_FALSE(is_looked_at_["b"]);
}

}  // namespace
}  // namespace vantage
