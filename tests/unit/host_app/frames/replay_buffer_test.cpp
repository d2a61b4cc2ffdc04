#include "host_app/frames/replay_buffer.h"

#include <gtest/gtest.h>

#include "tests/support/wire_frames.h"
#include "tests/unit/host_app/frames/scripted_feed.h"

namespace vantage {
namespace {

class ReplayBufferTest : public testing::Test {
  protected:
    FrameSet set(std::uint64_t k) const { return feed_.set(k, {"north"}); }
    std::uint64_t at(double pulse) const { return ring_.at(pulse)->trigger_index; }

    static constexpr std::size_t set_bytes = 46 * 62 * (4 + 2);
    ScriptedFeed feed_{{"north", "south"}};
    ReplayBuffer ring_{3 * set_bytes};
};

TEST_F(ReplayBufferTest, FindsTheFrameSetOfAPulseOrTheOneBefore) {
    EXPECT_FALSE(ring_.at(5));
    for (const std::uint64_t k : {10, 11, 14}) ring_.add(set(k));
    EXPECT_EQ(at(10), 10u);
    EXPECT_EQ(at(11.9), 11u);
    EXPECT_EQ(at(13), 11u) << "a gap is not filled";
    EXPECT_EQ(at(99), 14u);
    EXPECT_EQ(at(2), 10u);
}

TEST_F(ReplayBufferTest, DropsTheOldestToStayWithinItsMemory) {
    EXPECT_FALSE(ring_.span());
    for (std::uint64_t k = 1; k <= 100; ++k) {
        ring_.add(set(k));
        EXPECT_LE(ring_.span()->bytes, 3 * set_bytes);
    }
    EXPECT_EQ(ring_.span()->oldest, 98u);
    EXPECT_EQ(ring_.span()->newest, 100u);
    EXPECT_EQ(ring_.span()->sets, 3u);
}

TEST_F(ReplayBufferTest, IsClearedWhenTheStageRestarts) {
    ring_.add(set(1000));
    ring_.add(set(3));
    EXPECT_EQ(ring_.span()->sets, 1u);
    EXPECT_EQ(at(1000), 3u);
}

TEST_F(ReplayBufferTest, KeepsNoFrameSetLargerThanItsMemory) {
    ReplayBuffer small(set_bytes - 1);
    small.add(set(1));
    EXPECT_FALSE(small.span());
}

TEST_F(ReplayBufferTest, KeepsFramesEncodedAndDecodesThemOnAccess) {
    RigFrame sent = make_frame(7);
    const auto packed = std::make_shared<const PackedFrame>(FrameEncoder(85).encode(sent));
    auto frame = std::make_shared<RigFrame>(
        FrameDecoder().decode(packed->header, packed->colour, packed->disparity));
    frame->packed = packed;
    FrameSet set;
    set.trigger_index = 7;
    set.slots = {{"rig-a", frame, Absence::none}, {"rig-b", nullptr, Absence::late}};
    ReplayBuffer ring(1 << 20);
    ring.add(set);
    EXPECT_EQ(ring.span()->bytes,
              packed->header.size() + packed->colour.size() + packed->disparity.size());
    const std::optional<FrameSet> kept = ring.at(7);
    ASSERT_EQ(kept->slots.size(), 2u);
    EXPECT_NE(kept->slots[0].frame, frame);
    EXPECT_TRUE(same_pixels(kept->slots[0].frame->colour, frame->colour));
    EXPECT_TRUE(same_pixels(kept->slots[0].frame->disparity, frame->disparity));
    EXPECT_EQ(kept->slots[0].frame->exposure, frame->exposure);
    EXPECT_EQ(kept->slots[1].absence, Absence::late);
}

TEST_F(ReplayBufferTest, KeepsFrameSetsTakenFromAFeed) {
    const StageFeed feed = kept_feed(feed_.feed(), ring_);
    feed_.push(set(7));
    EXPECT_EQ(feed.next(std::chrono::seconds(10))->trigger_index, 7u);
    EXPECT_EQ(at(7), 7u);
    EXPECT_EQ(feed.status().sets, 1u);
}

}  // namespace
}  // namespace vantage
