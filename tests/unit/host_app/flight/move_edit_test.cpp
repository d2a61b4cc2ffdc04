#include "host_app/flight/moves/move_edit.h"

#include <gtest/gtest.h>

#include "tests/unit/host_app/flight/looking.h"

namespace vantage {
namespace {

Move three_keyframes() { return {{{0, looking(0)}, {2, looking(1)}, {5, looking(2)}}, false}; }

std::vector<double> times(const Move& move) {
    std::vector<double> times;
    for (const MoveKeyframe& keyframe : move.keyframes()) times.push_back(keyframe.time_s);
    return times;
}

TEST(MoveEdit, StartsWithOneKeyframe) {
    const Move move = appended(std::nullopt, looking(0.5), {}, 3, {});
    EXPECT_EQ(move.duration_s(), 0);
    EXPECT_EQ(move.at(7).azimuth_rad, 0.5);
    EXPECT_EQ(times(appended(move, looking(1), {}, 3, {})), (std::vector<double>{0, 3}));
}

TEST(MoveEdit, TakesItsTimesFromTheTakeWhilePlaybackMoves) {
    Move move = appended(std::nullopt, looking(0), 10.0, 3, {});
    move = appended(move, looking(1), 14.5, 3, {});
    move = appended(move, looking(2), 14.5, 3, {});
    EXPECT_EQ(times(move), (std::vector<double>{0, 4.5, 7.5}));
    EXPECT_NEAR(*move.take_s_at(2.25), 12.25, 1e-12);
    EXPECT_EQ(*move.take_s_at(6), 14.5) << "playback is frozen while the camera flies on";
    move = appended(move, looking(3), {}, 3, {});
    EXPECT_EQ(*move.take_s_at(100), 14.5) << "the last position stays";
}

TEST(MoveEdit, ReplacesAKeyframeOrInsertsOne) {
    const Move replaced = with_view_at(three_keyframes(), 2.01, looking(7), {});
    EXPECT_EQ(times(replaced), (std::vector<double>{0, 2, 5}));
    EXPECT_NEAR(replaced.at(2).azimuth_rad, 7 - 2 * M_PI, 1e-12) << "the shorter way round";
    const Move between = with_view_at(three_keyframes(), 3, looking(1.2), {});
    EXPECT_EQ(times(between), (std::vector<double>{0, 2, 3, 5}));
    EXPECT_NEAR(between.at(3).azimuth_rad, 1.2, 1e-12);
}

TEST(MoveEdit, RemovesKeyframesDownToTheLast) {
    const Move without_first = *without_keyframe(three_keyframes(), 0);
    EXPECT_EQ(times(without_first), (std::vector<double>{0, 3}))
        << "the move starts at its second keyframe";
    EXPECT_EQ(without_first.at(0).azimuth_rad, 1);
    EXPECT_FALSE(without_keyframe(*without_keyframe(without_first, 1), 0));
}

TEST(MoveEdit, ShiftsAKeyframeAndAllLaterOnes) {
    EXPECT_EQ(times(retimed(three_keyframes(), 1, 1.5)), (std::vector<double>{0, 3.5, 6.5}));
    const Move earlier = retimed(three_keyframes(), 2, -10);
    EXPECT_GT(earlier.duration_s(), 2);
    EXPECT_LT(earlier.duration_s(), 2.1);
    EXPECT_EQ(times(retimed(three_keyframes(), 0, 1)), (std::vector<double>{0, 2, 5}));
}

TEST(MoveEdit, LoopsWhileBothEndsShowTheSameView) {
    const Move loop({{0, looking(0)}, {2, looking(1)}, {5, looking(2 * M_PI)}}, true);
    EXPECT_TRUE(retimed(loop, 1, 1).loops());
    EXPECT_TRUE(with_view_at(loop, 1, looking(0.5), {}).loops());
    EXPECT_FALSE(appended(loop, looking(3), {}, 3, {}).loops());
}

}  // namespace
}  // namespace vantage
