#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/background/background_model.h"
#include "tests/unit/host_app/background/background_kinds.h"

namespace vantage {
namespace {

/// A patch in the middle of a grey wall at 4 m that stood still for some instants.
class BackgroundCompareTest : public testing::Test {
  protected:
    static constexpr int side_px = 33;
    cv::Rect patch{8, 8, 16, 16};
    const cv::Vec4b grey{120, 130, 110, 255}, red{220, 40, 30, 255};

    void see(const cv::Vec4b& colour, float depth_m) {
        DepthView view;
        view.K << 300, 0, 16, 0, 300, 16, 0, 0, 1;
        view.baseline_m = 0.2;
        view.colour = ColourImage(side_px, side_px, grey);
        view.colour(patch) = colour;
        view.depth_m = DepthImage(side_px, side_px, 4.0f);
        view.depth_m(patch) = depth_m;
        rig_.upload(view, 0.2);
        learner_.learn(rig_);
    }
    /// The model of the set knows better than its matcher how far the wall is.
    void background_model(float depth_m) {
        DepthView view = rig_.camera();
        view.colour = ColourImage(side_px, side_px, grey);
        view.depth_m = DepthImage(side_px, side_px, depth_m);
        const auto surface = std::make_shared<RigSurface>();
        surface->upload(view, corrector_, uploader_);
        rig_.set_background_model({.surface = surface, .made = rig_.learnt_instants()});
    }
    cv::Vec4b seen_at(int x, int y) const {
        return ColourImage(rig_.background_state().seen().download())(y, x);
    }
    /// What the patch is taken for after ten instants of the wall.
    int kind_of(const cv::Vec4b& colour, float depth_m) {
        for (int i = 0; i < 10; ++i) see(grey, 4);
        see(colour, depth_m);
        EXPECT_EQ(seen_at(2, 30)[0], the_set) << "beside it";
        return seen_at(16, 16)[0];
    }

    EglContext context_;
    ShaderLibrary shaders_;
    BackgroundModel learner_{shaders_};
    std::unique_ptr<ColourCorrector> corrector_;
    std::unique_ptr<DepthUploader> uploader_;
    RigHistory rig_;
};

TEST_F(BackgroundCompareTest, KnowsTheSetByItsColourWhateverTheMatcherSays) {
    EXPECT_EQ(kind_of(grey, 4), the_set);
    EXPECT_EQ(kind_of(grey, 2), the_set);
    EXPECT_EQ(kind_of(grey + cv::Vec4b(2, 2, 2, 0), 0), the_set) << "noise";
}

TEST_F(BackgroundCompareTest, TakesAFactorOfTheColourForLightAndShadow) {
    EXPECT_EQ(kind_of(grey * 0.6, 4), lit_background);
    EXPECT_EQ(kind_of(grey * 1.2, 4), lit_background);
    EXPECT_NE(kind_of(grey * 0.3, 4), lit_background) << "too dark for a shadow";
}

TEST_F(BackgroundCompareTest, KnowsAPerformerByColourAndNearness) { EXPECT_EQ(kind_of(red, 2), before_background); }

TEST_F(BackgroundCompareTest, KnowsAPerformerAsFarAsTheMatcherTakesTheSetToBe) {
    for (const float performer_m : {4.0f, 5.0f}) {
        for (int i = 0; i < 10; ++i) see(grey, 4);
        background_model(8);
        see(red, performer_m);
        EXPECT_EQ(seen_at(16, 16)[0], before_background) << performer_m << " m";
        see(grey * 0.6, 4);
        EXPECT_EQ(seen_at(16, 16)[0], lit_background) << "its shadow";
    }
}

TEST_F(BackgroundCompareTest, HoldsAGuessOfTheModelsAgainstNobody) {
    for (int i = 0; i < 10; ++i) see(grey, 4);
    background_model(-8);
    see(red, 4);
    EXPECT_EQ(seen_at(16, 16)[0], untold);
}

TEST_F(BackgroundCompareTest, CannotTellAnotherColourAtTheSetsDepthOrWithoutDepth) {
    EXPECT_EQ(kind_of(red, 4), untold);
    EXPECT_EQ(kind_of(red, 0), untold);
}

TEST_F(BackgroundCompareTest, BelievesWhatIsFartherAfterThreeInstants) {
    EXPECT_EQ(kind_of(red, 6), uncovered);
    see(red, 6);
    EXPECT_EQ(seen_at(16, 16)[0], uncovered);
    see(red, 6);
    EXPECT_EQ(seen_at(16, 16)[0], new_background);
    see(red, 6);
    EXPECT_EQ(seen_at(16, 16)[0], the_set);
}

/// Green: of a window; blue: of the pixel. The largest of red, green and blue.
TEST_F(BackgroundCompareTest, SaysHowFarTheColourIsFromTheSets) {
    (void)kind_of(grey + cv::Vec4b(0, 30, 9, 0), 2);
    // 2 of 255: the mean of the set is kept in halves of floats.
    EXPECT_NEAR(seen_at(16, 16)[1], 30, 2);
    EXPECT_NEAR(seen_at(16, 16)[2], 30, 2);
    // At the patch's left edge 9 of the window's 17 are inside.
    EXPECT_NEAR(seen_at(8, 16)[1], 30 * 11 / 17.0, 4);
}

/// A tile of 16 px is marked if a matte's reach of 6 px from it anything is apart.
TEST_F(BackgroundCompareTest, MarksTheTilesThatAMatteMayReach) {
    patch = {20, 8, 10, 16};
    (void)kind_of(red, 2);
    const ColourImage seen = rig_.background_state().seen().download();
    const cv::Mat1b tiles = rig_.matte_tiles().texture().download();
    ASSERT_EQ(tiles.size(), cv::Size(3, 3));
    for (int v = 0; v < 3; ++v)
        for (int u = 0; u < 3; ++u) {
            const cv::Rect reached = cv::Rect(16 * u - 6, 16 * v - 6, 28, 28);
            const cv::Rect apart = reached & patch;
            EXPECT_EQ(tiles(v, u), apart.empty() ? 0 : 255) << u << ' ' << v;
        }
}

}  // namespace
}  // namespace vantage
