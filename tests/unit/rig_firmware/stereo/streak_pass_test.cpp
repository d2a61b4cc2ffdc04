#include "rig_firmware/stereo/disparity/streak_pass.h"

#include <gtest/gtest.h>

#include "rig_firmware/stereo/volume/perm_pass.h"
#include "tests/references/stereo/streak_reference.h"
#include "tests/unit/rig_firmware/stereo/engine_buffers.h"

namespace vantage {
namespace {

constexpr int wall_px = 5, bar_px = 12;
constexpr unsigned short wall = wall_px * 32, bar = bar_px * 32;

/// A wall with a bar of another disparity across it, which alone costs nothing there.
struct StreakScene {
    DisparityImage disparity = DisparityImage(40, 60, wall);
    std::vector<cv::Mat1b> costs;

    /// wall_cost: what the wall's disparity costs where the bar is.
    StreakScene(int first_row, int rows, unsigned char wall_cost) {
        const cv::Rect place(10, first_row, 30, rows);
        disparity(place) = bar;
        for (int d = 0; d < 16; ++d) costs.emplace_back(disparity.size(), 60);
        costs[wall_px].setTo(0);
        costs[wall_px](place) = wall_cost;
        costs[bar_px](place) = 0;
    }
    int left_of_bar() const { return cv::countNonZero(without_streaks(disparity, costs) == bar); }
};

TEST(WithoutStreaks, MakesABarUnknownWhereTheWallLooksHardlyWorse) {
    const StreakScene scene(10, max_streak_rows, max_streak_gain);
    const DisparityImage result = without_streaks(scene.disparity, scene.costs);
    EXPECT_EQ(cv::countNonZero(result == 0), 30 * max_streak_rows);
    EXPECT_EQ(cv::countNonZero(result == wall), 40 * 60 - 30 * max_streak_rows);
}

TEST(WithoutStreaks, LeavesWhatIsThinAndTrulyBeforeTheWall) {
    EXPECT_EQ(StreakScene(20, 3, max_streak_gain + 1).left_of_bar(), 30 * 3);
    StreakScene bare(20, 3, max_streak_gain);
    bare.costs[wall_px + 3] = max_streak_gain + min_streak_valley - 1;
    EXPECT_EQ(bare.left_of_bar(), 30 * 3) << "the wall is no match of its own there";
    bare.costs[wall_px + 3] = max_streak_gain + min_streak_valley;
    EXPECT_EQ(bare.left_of_bar(), 0);
}

TEST(WithoutStreaks, LeavesWhatIsHigherOrHasNotOneSurfaceAboveAndBelow) {
    EXPECT_EQ(StreakScene(10, max_streak_rows + 1, 0).left_of_bar(), 30 * (max_streak_rows + 1));
    EXPECT_EQ(StreakScene(0, 4, 0).left_of_bar(), 30 * 4) << "at the picture's edge";
    EXPECT_EQ(StreakScene(36, 4, 0).left_of_bar(), 30 * 4);
    StreakScene step(20, 4, 0);
    step.disparity.rowRange(24, 40) = wall + 64;
    EXPECT_EQ(step.left_of_bar(), 30 * 4);
}

TEST(WithoutStreaks, LooksPastWhatIsUnknown) {
    StreakScene scene(20, 4, 0);
    scene.disparity.row(19) = 0;
    scene.disparity.row(22) = 0;
    scene.disparity.row(24) = 0;
    EXPECT_EQ(scene.left_of_bar(), 0);
}

class StreakPassTest : public EnginePassTest {};

TEST_P(StreakPassTest, AgreesWithTheCpuBitForBit) {
    const auto [width_px, height_px, disparities] = GetParam();
    PermPass perm(library_, layout_, disparities, PermOutput::costs);
    LumaPass luma(library_, layout_);
    FeaturePass features(library_, layout_, disparities);
    PermeabilityPass permeability(library_, layout_, 9);
    Texture left(TextureFormat::rgba8, width_px, height_px),
        right(TextureFormat::rgba8, width_px, height_px);
    left.upload(pair_.left);
    right.upload(pair_.right);
    luma.run(profiler_, left, right);
    features.run(profiler_, luma);
    permeability.run(profiler_, luma.left());
    perm.run(profiler_, features, permeability);
    const std::vector<cv::Mat1b> costs =
        perm_costs(feature_words(left_), feature_words(right_),
                   permeability_of(guide_of(left_), permeability_table(9)), disparities);

    // Bars of all heights, holes, and noise of less than a pixel.
    cv::RNG random(3);
    DisparityImage disparity(height_px, width_px);
    for (int y = 0; y < height_px; ++y) {
        const int level = random.uniform(0, 3) == 0 ? random.uniform(1, disparities) : 3;
        for (int x = 0; x < width_px; ++x)
            disparity(y, x) = static_cast<unsigned short>(
                random.uniform(0, 12) == 0 ? 0 : std::max(32 * level + random.uniform(-16, 1), 1));
    }
    const DisparityImage expected = without_streaks(disparity, costs);
    ASSERT_GT(cv::countNonZero(disparity) - cv::countNonZero(expected), width_px) << "some go";

    const Buffer changed = buffer_of(disparity, layout_, 77);
    StreakPass(library_, layout_, disparities).run(profiler_, changed, perm.costs());
    const cv::Mat1i words = channel_of(changed, layout_, 1, 0);
    expect_equal(lower_half(words), as_int(expected), "disparity");
    const cv::Mat1i confidence = upper_half(words);
    for (int y = 0; y < height_px; ++y)
        for (int x = 0; x < width_px; ++x)
            if (disparity(y, x)) {
                ASSERT_EQ(confidence(y, x), expected(y, x) ? 77 : 0) << x << ", " << y;
            }
}

INSTANTIATE_TEST_SUITE_P(OddSizes, StreakPassTest,
                         testing::Values(PassCase{61, 47, 13}, PassCase{16, 16, 16},
                                         PassCase{51, 263, 37}, PassCase{311, 239, 21}));

}  // namespace
}  // namespace vantage
