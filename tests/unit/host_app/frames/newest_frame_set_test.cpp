#include "host_app/frames/newest_frame_set.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/unit/host_app/frames/scripted_feed.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

TEST(NewestFrameSet, ReturnsTheNewestAndCountsReplacedFrames) {
    ScriptedFeed feed({"a", "b"});
    NewestFrameSet newest(feed.feed());
    for (std::uint64_t k = 0; k < 10; ++k)
        feed.push(feed.set(
            k, k % 2 ? std::vector<std::string>{"a", "b"} : std::vector<std::string>{"a"}));
    // All ten are either taken or counted as replaced, whatever the timing of the threads.
    RigCounts taken;
    std::uint64_t taken_frame_sets = 0, last = 0;
    while (last < 9) {
        const std::optional<FrameSet> set = newest.take(10s);
        ASSERT_TRUE(set);
        EXPECT_TRUE(taken_frame_sets == 0 || set->trigger_index > last);
        last = set->trigger_index;
        ++taken_frame_sets;
        count_frames(*set, taken);
    }
    const NewestFrameSet::Replaced replaced = newest.replaced();
    EXPECT_EQ(taken_frame_sets + replaced.sets, 10u);
    const auto frames = [&](const std::string& rig) {
        const auto found = replaced.frames.find(rig);
        return taken[rig] + (found == replaced.frames.end() ? 0 : found->second);
    };
    EXPECT_EQ(frames("a"), 10u);
    EXPECT_EQ(frames("b"), 5u);
}

TEST(NewestFrameSet, ReturnsAFrameSetOnce) {
    ScriptedFeed feed({"a"});
    NewestFrameSet newest(feed.feed());
    feed.push(feed.set(1, {"a"}));
    EXPECT_TRUE(newest.take(10s));
    EXPECT_FALSE(newest.take());
}

TEST(NewestFrameSet, CountsEveryFrameSetAtTheEnd) {
    ScriptedFeed feed({"a"});
    NewestFrameSet newest(feed.feed());
    for (std::uint64_t k = 0; k < 30; ++k) feed.push(feed.set(k, {"a"}));
    std::uint64_t taken = 0;
    for (int i = 0; i < 3; ++i) taken += newest.take(1ms).has_value();
    EXPECT_EQ(newest.close().sets, 30u);
    EXPECT_EQ(newest.replaced().sets + taken, 30u);
    EXPECT_FALSE(newest.take());
}

TEST(NewestFrameSet, ThrowsTheErrorOfTheFeed) {
    ScriptedFeed feed({"a"});
    feed.fail_with("the receiver broke");
    NewestFrameSet newest(feed.feed());
    EXPECT_THROW(newest.take(10s), Error);
}

}  // namespace
}  // namespace vantage
