#include "host_app/refine/multi_view_refinement.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "host_app/surfaces/rig_history.h"
#include "tests/unit/host_app/fused/wall_and_square.h"

namespace vantage {
namespace {

constexpr int refinement_width_px = 161, refinement_height_px = 107;
constexpr double f_px = 400, baseline_m = 0.5;
constexpr float far_wall_m = 4;
/// A region that both cameras see and that does not overlap with itself when its depth changes.
const cv::Rect behind(120, 60, 20, 16);

/// A wall that fills the picture of a camera at (x, 0, 0) that looks along z.
DepthView wall(double x_m) {
    DepthView view;
    view.name = std::to_string(x_m);
    view.K << f_px, 0, 0.5 * (refinement_width_px - 1), 0, f_px, 0.5 * (refinement_height_px - 1),
        0, 0, 1;
    view.world_from_camera.translation().x() = x_m;
    view.baseline_m = baseline_m;
    view.colour =
        ColourImage(refinement_height_px, refinement_width_px, cv::Vec4b(90, 120, 150, 255));
    view.depth_m = DepthImage(refinement_height_px, refinement_width_px, far_wall_m);
    return view;
}

/// A rig beside another one that stands only a baseline away.
class FaultyPairTest : public testing::Test {
  protected:
    DepthImage refined(const DepthView& own, const DepthView& other, bool is_matched = false) {
        const DepthView pair[] = {own, other};
        RigRoster views;
        views.upload(pair, nominal_dt_s);
        ComparedView view = compared(*views.shown()[0]);
        view.is_matched = is_matched;
        return refinement_.refine(view, compared(views.shown())).download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
    MultiViewRefinement refinement_{shaders_};
};

TEST_F(FaultyPairTest, KeepsUnconfirmedDepthInAMapThatHardlyErrs) {
    DepthView own = wall(0);
    own.depth_m(behind) = 1.5f * far_wall_m;
    const DepthImage kept = refined(own, wall(baseline_m));
    EXPECT_EQ(cv::norm(kept, own.depth_m, cv::NORM_INF), 0);
}

TEST_F(FaultyPairTest, MarksUnconfirmedDepthInAMapThatErrsAsInpainted) {
    DepthView own = wall(0);
    own.depth_m(behind) = 1.5f * far_wall_m;
    // A tenth of the map is before the wall, and the other camera sees the wall through it.
    const cv::Rect before(130, 5, 30, 40);
    own.depth_m(before) = 0.9f * far_wall_m;
    const DepthImage left = refined(own, wall(baseline_m));
    EXPECT_EQ(cv::countNonZero(left(before)), 0);
    EXPECT_EQ(cv::countNonZero(left(behind) != -1.5f * far_wall_m), 0);
    // Depth that it confirms, and depth outside its picture, stays.
    EXPECT_EQ(cv::countNonZero(left(cv::Rect(60, 60, 50, 40)) != far_wall_m), 0);
    EXPECT_EQ(cv::countNonZero(left(cv::Rect(0, 0, 40, refinement_height_px)) != far_wall_m), 0);
}

TEST_F(FaultyPairTest, OnlyCarvesDepthFromBackgroundStereo) {
    DepthView own = wall(0);
    own.depth_m(behind) = 1.5f * far_wall_m;
    const cv::Rect before(130, 5, 30, 40);
    own.depth_m(before) = 0.9f * far_wall_m;
    DepthImage carved = own.depth_m.clone();
    carved(before) = 0;
    EXPECT_EQ(cv::norm(refined(own, wall(baseline_m), true), carved, cv::NORM_INF), 0);
}

/// Both matchers may err in the same way: then the surfaces match and the colours do not.
TEST_F(FaultyPairTest, MarksDepthWhoseColoursDoNotMatchAsInpainted) {
    DepthView own = wall(0);
    own.depth_m(cv::Rect(130, 5, 30, 40)) = 0.9f * far_wall_m;
    own.colour(behind).setTo(cv::Scalar(200, 20, 20, 255));
    const DepthImage left = refined(own, wall(baseline_m));
    EXPECT_EQ(cv::countNonZero(left(behind) != -far_wall_m), 0);
    EXPECT_EQ(cv::countNonZero(left(cv::Rect(60, 60, 50, 40)) != far_wall_m), 0);
}

/// A rig that stands farther away than a baseline often cannot confirm correct depth.
TEST_F(FaultyPairTest, KeepsDepthThatAFartherRigCannotConfirm) {
    DepthView own = wall(0);
    own.baseline_m = baseline_m / 5;
    own.depth_m(behind) = 1.5f * far_wall_m;
    own.depth_m(cv::Rect(130, 5, 30, 40)) = 0.7f * far_wall_m;
    DepthView other = wall(baseline_m);
    other.baseline_m = own.baseline_m;
    EXPECT_EQ(cv::countNonZero(refined(own, other)(behind)), behind.area());
}

/// A rig between two others before a wall and a square, whose matcher assigned a strip of the wall
/// to the square beside it.
class WrongStripTest : public testing::Test {
  protected:
    static constexpr int refinement_width_px = 161, refinement_height_px = 119;
    static constexpr float far_wall_m = 4, square_m = 2;
    static const cv::Rect strip;

    static DepthView film(double x_m) {
        DepthView view =
            wall_and_square(x_m, refinement_width_px, refinement_height_px, {.waves = true});
        view.baseline_m = 0.05;
        return view;
    }

    DepthImage refined_strip(const DepthView& own, bool is_matched = false) {
        const DepthView rigs[] = {own, film(-0.4), film(0.4)};
        RigRoster views;
        views.upload(rigs, nominal_dt_s);
        ComparedView view = compared(*views.shown()[0]);
        view.is_matched = is_matched;
        return refinement_.refine(view, compared(views.shown())).download()(strip);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    MultiViewRefinement refinement_{shaders_};
};

const cv::Rect WrongStripTest::strip(42, 40, 6, 40);

TEST_F(WrongStripTest, AdoptsTheDepthBesideItThatThePicturesMatchWith) {
    DepthView own = film(0);
    ASSERT_EQ(cv::countNonZero(own.depth_m(strip) != far_wall_m), 0);
    ASSERT_EQ(own.depth_m(60, 50), square_m);
    own.depth_m(strip) = square_m;
    const DepthImage mended = refined_strip(own);
    const int right = cv::countNonZero(cv::abs(mended - far_wall_m) < 0.03 * far_wall_m);
    EXPECT_GE(right, 0.9 * strip.area()) << mended;
}

TEST_F(WrongStripTest, OfBackgroundStereoAdoptsDepthOnlyWhereItIsCarvedAway) {
    DepthView own = film(0);
    own.depth_m(strip) = 1.3f * far_wall_m;
    EXPECT_EQ(cv::countNonZero(refined_strip(own, true) != 1.3f * far_wall_m), 0);
    own.depth_m(strip) = square_m;
    const DepthImage mended = refined_strip(own, true);
    EXPECT_GE(cv::countNonZero(mended == far_wall_m), 0.9 * strip.area()) << mended;
}

TEST_F(WrongStripTest, KeepsItsDepthInAMapThatHardlyErrs) {
    DepthView own = film(0);
    // Fewer wrong pixels than exact depth may have.
    const cv::Rect few(strip.x, strip.y, 3, 12);
    own.depth_m(few) = 1.3f * far_wall_m;
    const DepthImage kept = refined_strip(own);
    EXPECT_EQ(cv::norm(kept, own.depth_m(strip), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace vantage
