#include "host_app/takes/take_frame_sets.h"

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/support/wire_frames.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

class TakeFrameSetsTest : public testing::Test {
  protected:
    void write(const std::vector<std::uint64_t>& gaps = {}) {
        write_small_take(file_, {"north", "south"}, 100, 160, gaps);
    }
    std::shared_ptr<const TakeReader> reader() const {
        return std::make_shared<const TakeReader>(file_);
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "take.mkv";
};

TEST_F(TakeFrameSetsTest, SeeksInAnyOrder) {
    write();
    const TakeFrameSets sets(reader());
    EXPECT_EQ(sets.span()->oldest, 100u);
    EXPECT_EQ(sets.span()->newest, 160u);
    EXPECT_EQ(sets.span()->sets, 61u);
    // On, back, and all over the place.
    std::vector<std::uint64_t> order;
    for (std::uint64_t pulse = 100; pulse <= 160; ++pulse) order.push_back(pulse);
    for (std::uint64_t pulse = 160; pulse >= 100; --pulse) order.push_back(pulse);
    for (std::uint64_t i = 0; i < 100; ++i) order.push_back(100 + (i * 37) % 61);
    for (const std::uint64_t pulse : order) {
        const std::optional<FrameSet> set = sets.at(static_cast<double>(pulse) + 0.4);
        ASSERT_EQ(set->trigger_index, pulse);
        ASSERT_EQ(set->present(), 2);
        for (const FrameSet::Slot& slot : set->slots) {
            EXPECT_EQ(slot.frame->rig, slot.rig);
            EXPECT_EQ(slot.frame->trigger_index, pulse);
        }
    }
    const PackedFrame sent = sent_frame("south", 140);
    const RigFrame then = FrameDecoder().decode(sent.header, sent.colour, sent.disparity);
    EXPECT_TRUE(same_pixels(sets.at(140)->slots[1].frame->colour, then.colour));
    EXPECT_TRUE(same_pixels(sets.at(140)->slots[1].frame->disparity, then.disparity));
}

TEST_F(TakeFrameSetsTest, KeepsGapsAndStaysWithinItsEnds) {
    write({120});
    const TakeFrameSets sets(reader());
    EXPECT_EQ(sets.at(120)->present(), 1);
    EXPECT_EQ(sets.at(120)->slots[1].absence, Absence::missed_by_rig);
    EXPECT_EQ(sets.at(3)->trigger_index, 100u);
    EXPECT_EQ(sets.at(1e9)->trigger_index, 160u);
    EXPECT_EQ(sets.pulse_at(119.99), 119u);
}

TEST_F(TakeFrameSetsTest, ShowsUndamagedFramesOfADamagedTake) {
    write();
    std::vector<std::byte> bytes = bytes_of_file(file_);
    bytes[reader()->frames(0)[30].colour.at + 50] ^= std::byte{1};
    write_bytes(file_, bytes);
    const TakeFrameSets sets(reader());
    EXPECT_EQ(sets.at(130)->present(), 1);
    EXPECT_EQ(sets.at(131)->present(), 2);
}

TEST_F(TakeFrameSetsTest, DecodesASeekTargetAloneAndThenAhead) {
    write();
    std::vector<std::byte> bytes = bytes_of_file(file_);
    bytes[reader()->frames(0)[31].colour.at + 50] ^= std::byte{1};
    write_bytes(file_, bytes);
    // Whoever decodes the set of pulse 131 is told that it is damaged.
    const auto log_of = [&](const std::vector<double>& pulses) {
        testing::internal::CaptureStderr();
        {
            const TakeFrameSets sets(reader());
            for (const double pulse : pulses) sets.at(pulse);
        }
        return testing::internal::GetCapturedStderr();
    };
    using Pulses = std::vector<double>;
    for (const Pulses& jumps :
         {Pulses{130}, {110, 130}, {110, 111, 112, 130}, {150, 132}, {150, 149, 132}, {130, 130}})
        EXPECT_EQ(log_of(jumps), "") << jumps.size();
    for (const Pulses& steps : {Pulses{128, 129, 130},
                                {127, 128, 129, 130},
                                {125, 127, 129},
                                {140, 137, 134},
                                {134, 133, 132}})
        EXPECT_NE(log_of(steps).find("is damaged"), std::string::npos) << steps.front();
}

TEST_F(TakeFrameSetsTest, RefusesATakeWithoutFrames) {
    {
        TakeWriter writer(file_, small_facts({"north"}, 100));
        writer.finish();
    }
    EXPECT_NE(thrown_sentence([&] { TakeFrameSets sets(reader()); }).find("has no frames"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
