#include "rig_firmware/stereo/disparity/path_fill_pass.h"

#include <gtest/gtest.h>

#include "rig_firmware/stereo/features/luma_pass.h"
#include "tests/references/stereo/path_fill_reference.h"
#include "tests/unit/rig_firmware/stereo/engine_buffers.h"

namespace vantage {
namespace {

constexpr unsigned short back_wall = 320, board = 1280;  // 10 and 40 px

/// A dark board before a light wall. The 30 px of the wall left of the board only one camera sees.
struct FillScene {
    StereoPlanes picture{GreyImage(40, 120, 200), GreyImage(40, 120, 128)};
    DisparityImage disparity = DisparityImage(40, 120, back_wall);

    FillScene() {
        picture.luma.colRange(70, 120) = 50;
        disparity.colRange(70, 120) = board;
        disparity.colRange(40, 70) = 0;
    }
};

TEST(FilledAlongPaths, GivesWhatIsHiddenTheDepthThatItsColourLeadsTo) {
    FillScene scene;
    // A ledge at 20 px, of another colour, goes on into what is hidden.
    scene.disparity(cv::Rect(0, 10, 50, 10)) = 640;
    scene.picture.luma(cv::Rect(0, 10, 70, 10)) = 120;
    for (const FillCell cell : {FillCell::one_px, FillCell::two_px}) {
        const DisparityImage filled = filled_along_paths(scene.disparity, scene.picture, cell);
        EXPECT_EQ(filled(5, 60), back_wall);
        EXPECT_EQ(filled(14, 65), 640);
        EXPECT_EQ(filled(30, 60), back_wall);
        EXPECT_EQ(filled(30, 100), board);
    }
}

TEST(FilledAlongPaths, NeverTakesADepthThatTheOtherCameraWouldSee) {
    FillScene scene;
    // As dark as the board: by colour alone it were the board's.
    scene.picture.luma.colRange(40, 120) = 50;
    const DisparityImage filled =
        filled_along_paths(scene.disparity, scene.picture, FillCell::two_px);
    EXPECT_EQ(cv::countNonZero(filled.colRange(40, 70) == back_wall), 30 * 40);
}

TEST(FilledAlongPaths, DoesNotSpreadSmallIslandsAndReplacesThoseThatAreHidden) {
    FillScene scene;
    scene.disparity(cv::Rect(50, 20, 4, 4)) = 64;
    scene.disparity(cv::Rect(10, 20, 4, 4)) = 64;
    const DisparityImage filled =
        filled_along_paths(scene.disparity, scene.picture, FillCell::two_px);
    EXPECT_EQ(filled(21, 51), back_wall)
        << "something nearer hides it: it cannot have been matched";
    EXPECT_EQ(filled(21, 58), back_wall) << "not spread";
    EXPECT_EQ(filled(21, 11), 64) << "nothing hides it: what is known stays";
}

TEST(FilledAlongPaths, FillsWhatLiesBeyondTheOtherCamerasBorder) {
    FillScene scene;
    scene.disparity.colRange(0, 10) = 0;
    const DisparityImage filled =
        filled_along_paths(scene.disparity, scene.picture, FillCell::two_px);
    EXPECT_EQ(cv::countNonZero(filled.colRange(0, 10) == back_wall), 10 * 40);
}

TEST(FilledAlongPaths, TakesTheBackgroundOfTheRowWhereNothingHides) {
    FillScene scene;
    scene.disparity.colRange(90, 100) = 0;
    scene.disparity.colRange(100, 120) = board + 160;
    const DisparityImage filled =
        filled_along_paths(scene.disparity, scene.picture, FillCell::two_px);
    EXPECT_EQ(cv::countNonZero(filled.colRange(90, 100) == board), 10 * 40);
}

TEST(FilledAlongPaths, TakesWhatThereIsInARowThatHasNothingBetter) {
    FillScene scene;
    scene.disparity = 0;
    scene.disparity(4, 7) = 64;
    scene.disparity(4, 8) = 64;
    const DisparityImage filled =
        filled_along_paths(scene.disparity, scene.picture, FillCell::one_px);
    EXPECT_EQ(cv::countNonZero(filled.row(4) == 64), 120);
    EXPECT_EQ(
        cv::countNonZero(filled_along_paths(scene.disparity * 0, scene.picture, FillCell::two_px)),
        0)
        << "out of nothing comes nothing";
}

class PathFillPassTest : public EnginePassTest {};

/// Blobs, specks and gaps of all kinds.
TEST_P(PathFillPassTest, AgreesWithItsCpuFormBitForBit) {
    cv::RNG random(7);
    DisparityImage disparity(layout_.height_px, layout_.width_px, static_cast<unsigned short>(0));
    for (int i = 0; i < layout_.width_px * layout_.height_px / 40; ++i) {
        const cv::Rect blob(random.uniform(-9, layout_.width_px),
                            random.uniform(-9, layout_.height_px), random.uniform(1, 20),
                            random.uniform(1, 20));
        const int d = random.uniform(0, 3) ? random.uniform(1, GetParam().disparities * 32) : 0;
        disparity(blob & cv::Rect(0, 0, layout_.width_px, layout_.height_px)) =
            static_cast<unsigned short>(d);
    }
    Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    left.upload(pair_.left);
    LumaPass luma(library_, layout_);
    luma.run(profiler_, left, left);
    const Buffer known = buffer_of(disparity, layout_, 77), filled(known.bytes(), GL_DYNAMIC_COPY);
    for (const FillCell cell : {FillCell::one_px, FillCell::two_px}) {
        PathFillPass fill(library_, layout_, cell);
        fill.run(profiler_, luma.left(), known, filled);
        const DisparityImage expected = filled_along_paths(disparity, left_, cell);
        const cv::Mat1i result = channel_of(filled, layout_, 1, 0);
        expect_equal(lower_half(result), as_int(expected), "filled");
        for (int y = 0; y < disparity.rows; ++y)
            for (int x = 0; x < disparity.cols; ++x) {
                const bool is_measured = disparity(y, x) && disparity(y, x) == expected(y, x);
                const int confidence = static_cast<int>(static_cast<unsigned>(result(y, x)) >> 16);
                if (!is_measured) {
                    ASSERT_EQ(confidence, 0) << x << ", " << y;
                }
            }
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, PathFillPassTest,
                         testing::Values(PassCase{64, 48, 16}, PassCase{131, 77, 40},
                                         PassCase{37, 1, 9}, PassCase{1, 23, 4},
                                         PassCase{130, 98, 64}),
                         [](const auto& test) {
                             return std::to_string(test.param.width) + "x" +
                                    std::to_string(test.param.height);
                         });

}  // namespace
}  // namespace vantage
