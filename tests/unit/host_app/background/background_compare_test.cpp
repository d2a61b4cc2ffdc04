#include <vector>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/background/background_model.h"
#include "tests/unit/host_app/background/background_kinds.h"

namespace vantage {
namespace {

/// A patch that changes in the middle of a grey wall at 4 m.
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
    /// Gives the rig a model of the background with a different depth than its matcher's.
    void set_model(float depth_m) {
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
    /// The kind of the patch after ten instants of the wall.
    int kind_of(const cv::Vec4b& colour, float depth_m) {
        for (int i = 0; i < 10; ++i) see(grey, 4);
        see(colour, depth_m);
        EXPECT_EQ(seen_at(2, 30)[0], the_background) << "beside it";
        return seen_at(16, 16)[0];
    }

    EglContext context_;
    ShaderLibrary shaders_;
    BackgroundModel learner_{shaders_};
    std::unique_ptr<ColourCorrector> corrector_;
    std::unique_ptr<DepthUploader> uploader_;
    RigHistory rig_;
};

TEST_F(BackgroundCompareTest, RecognisesTheBackgroundByColourDespiteWrongDepth) {
    EXPECT_EQ(kind_of(grey, 4), the_background);
    EXPECT_EQ(kind_of(grey, 2), the_background);
    EXPECT_EQ(kind_of(grey + cv::Vec4b(2, 2, 2, 0), 0), the_background) << "noise";
}

TEST_F(BackgroundCompareTest, TreatsAScaledColourAsLightOrShadow) {
    EXPECT_EQ(kind_of(grey * 0.6, 4), lit_background);
    EXPECT_EQ(kind_of(grey * 1.2, 4), lit_background);
    EXPECT_NE(kind_of(grey * 0.3, 4), lit_background) << "too dark for a shadow";
}

TEST_F(BackgroundCompareTest, RecognisesForegroundByColourAndDepth) {
    EXPECT_EQ(kind_of(red, 2), before_background);
}

TEST_F(BackgroundCompareTest, RecognisesForegroundAtTheDepthThatTheMatcherGivesTheBackground) {
    for (const float performer_m : {4.0f, 5.0f}) {
        for (int i = 0; i < 10; ++i) see(grey, 4);
        set_model(8);
        see(red, performer_m);
        EXPECT_EQ(seen_at(16, 16)[0], before_background) << performer_m << " m";
        see(grey * 0.6, 4);
        EXPECT_EQ(seen_at(16, 16)[0], lit_background) << "its shadow";
    }
}

TEST_F(BackgroundCompareTest, IgnoresInpaintedDepthOfTheModel) {
    for (int i = 0; i < 10; ++i) see(grey, 4);
    set_model(-8);
    see(red, 4);
    EXPECT_EQ(seen_at(16, 16)[0], undecided);
}

TEST_F(BackgroundCompareTest, LeavesAnotherColourAtTheBackgroundsDepthUndecided) {
    EXPECT_EQ(kind_of(red, 4), undecided);
    EXPECT_EQ(kind_of(red, 0), undecided);
}

TEST_F(BackgroundCompareTest, AcceptsAFartherSurfaceAfterThreeInstants) {
    EXPECT_EQ(kind_of(red, 6), uncovered);
    see(red, 6);
    EXPECT_EQ(seen_at(16, 16)[0], uncovered);
    see(red, 6);
    EXPECT_EQ(seen_at(16, 16)[0], new_background);
    see(red, 6);
    EXPECT_EQ(seen_at(16, 16)[0], the_background);
}

/// Green is the change of a window, blue that of the pixel.
TEST_F(BackgroundCompareTest, MeasuresTheChangeOfColour) {
    (void)kind_of(grey + cv::Vec4b(0, 30, 9, 0), 2);
    // Within 2 of 255, since the mean is stored in half floats.
    EXPECT_NEAR(seen_at(16, 16)[1], 30, 2);
    EXPECT_NEAR(seen_at(16, 16)[2], 30, 2);
    // At the patch's left edge 9 of the window's 17 are inside.
    EXPECT_NEAR(seen_at(8, 16)[1], 30 * 11 / 17.0, 4);
}

/// A tile of 16 px is marked if a pixel that is not background lies within the reach of a matte, 6
/// px.
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

/// A thing without texture that is measured at its edges only, and whose colour may be the wall's
/// in another light.
class PlainForegroundTest : public testing::Test {
  protected:
    static constexpr int plain_width_px = 96, plain_height_px = 80;
    const cv::Rect box{30, 20, 36, 40};
    const cv::Vec4b wall{120, 130, 110, 255};

    static DepthView wall_view(const cv::Vec4b& colour) {
        DepthView view;
        view.K << 300, 0, 48, 0, 300, 40, 0, 0, 1;
        view.baseline_m = 0.2;
        view.colour = ColourImage(plain_height_px, plain_width_px, colour);
        view.depth_m = DepthImage(plain_height_px, plain_width_px, 4.0f);
        return view;
    }
    void see(const DepthView& view) {
        rig_.upload(view, 0.2);
        learner_.learn(rig_);
    }
    /// The matte of a box of this colour, with depth of its own on the rims that are given.
    cv::Mat1b matte_of(const cv::Vec4b& colour, const std::vector<cv::Rect>& rims) {
        for (int i = 0; i < 10; ++i) see(wall_view(wall));
        DepthView view = wall_view(wall);
        view.colour(box) = colour;
        for (const cv::Rect& rim : rims) view.depth_m(rim) = 2.0f;
        see(view);
        return rig_.matte().download();
    }
    std::vector<cv::Rect> all_rims() const {
        return {{box.x, box.y, box.width, 4},
                {box.x, box.br().y - 4, box.width, 4},
                {box.x, box.y, 4, box.height},
                {box.br().x - 4, box.y, 4, box.height}};
    }

    EglContext context_;
    ShaderLibrary shaders_;
    BackgroundModel learner_{shaders_};
    RigHistory rig_;
};

TEST_F(PlainForegroundTest, IsWholeWhereItsEdgesAreMeasured) {
    for (const cv::Vec4b& colour : {cv::Vec4b(220, 40, 30, 255), cv::Vec4b(wall * 0.7)}) {
        const cv::Mat1b matte = matte_of(colour, all_rims());
        EXPECT_EQ(cv::countNonZero(matte(box) > 127), box.area()) << colour;
        EXPECT_EQ(matte(5, 5), 0);
    }
}

/// A shadow borders on what throws it on one side only.
TEST_F(PlainForegroundTest, DoesNotTakeTheShadowBesideIt) {
    const cv::Mat1b matte = matte_of(wall * 0.7, {{box.x, box.y, box.width, 8}});
    const cv::Rect shadow(box.x, box.y + 14, box.width, box.height - 14);
    EXPECT_EQ(cv::countNonZero(matte(shadow) > 127), 0);
}

}  // namespace
}  // namespace vantage
