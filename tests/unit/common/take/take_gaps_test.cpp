#include <gtest/gtest.h>

#include "common/take/take_check.h"

namespace vantage {
namespace {

/// Frames of these pulses, with what the rig had missed by then as it told it with each.
std::vector<TakeReader::Frame> frames_of(
    const std::vector<std::pair<std::uint64_t, std::uint64_t>>& pulses_and_missed) {
    std::vector<TakeReader::Frame> frames;
    for (const auto& [pulse, missed] : pulses_and_missed) {
        TakeReader::Frame frame;
        frame.pulse = pulse;
        frame.rig.missed = missed;
        frames.push_back(frame);
    }
    return frames;
}

std::string whys_of(const std::vector<TakeReader::Frame>& frames) {
    std::string text;
    for (const TakeGap& gap : gaps_between("north", frames))
        text += fmt::format("{}-{}: {}; ", gap.from, gap.to, gap.why);
    return text;
}

TEST(TakeGapsTest, ContiguousPulsesHaveNoGap) {
    EXPECT_EQ(whys_of(frames_of({{5, 1}, {6, 1}, {7, 2}})), "");
    EXPECT_EQ(whys_of({}), "");
}

TEST(TakeGapsTest, AssignsLossesCountedAhead) {
    // The rig had missed 6 and 7, and 9, before it packed 5 and 8.
    EXPECT_EQ(whys_of(frames_of({{4, 0}, {5, 3}, {8, 3}, {10, 3}})),
              "6-7: 2 missed by the rig; 9-9: 1 missed by the rig; ");
}

TEST(TakeGapsTest, AssignsLossesCountedLater) {
    std::vector<TakeReader::Frame> frames = frames_of({{4, 0}, {6, 0}, {7, 0}, {9, 0}, {10, 0}});
    for (std::size_t i = 2; i < frames.size(); ++i) frames[i].link.send_dropped = 1;
    frames[4].link.send_dropped = 2;
    EXPECT_EQ(whys_of(frames), "5-5: 1 dropped at the rig; 8-8: 1 dropped at the rig; ");
}

TEST(TakeGapsTest, AGapCanHaveSeveralReasons) {
    std::vector<TakeReader::Frame> frames = frames_of({{4, 0}, {9, 1}});
    frames[1].rig.late = 2;
    frames[1].dropped = 1;
    EXPECT_EQ(whys_of(frames),
              "5-8: 1 missed by the rig, 2 late at the rig, 1 dropped by the recording host; ");
}

TEST(TakeGapsTest, AnUncountedLossHasNoReason) {
    EXPECT_EQ(whys_of(frames_of({{4, 7}, {6, 7}})), "5-5: ; ");
    // Long after the gap the rig lost what the take has another frame of.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> pulses{{4, 0}, {6, 0}};
    for (std::uint64_t pulse = 7; pulse < 30; ++pulse) pulses.emplace_back(pulse, 0);
    pulses.emplace_back(30, 1);
    EXPECT_EQ(whys_of(frames_of(pulses)), "5-5: ; ");
}

TEST(TakeGapsTest, ExplainsARestartOfTheRig) {
    std::vector<TakeReader::Frame> frames = frames_of({{4, 3}, {9, 0}, {11, 1}});
    frames[1].session = frames[2].session = 1;
    EXPECT_EQ(whys_of(frames), "5-8: the rig was restarted; 10-10: 1 missed by the rig; ");
}

}  // namespace
}  // namespace vantage
