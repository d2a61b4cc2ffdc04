#include "host_app/instants/depth_steadier.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/egl_context.h"
#include "host_app/instants/colour_steadier.h"
#include "tests/unit/synthesis/wall_and_square.h"

namespace vantage {
namespace {

/// A rig whose depth comes instant by instant.
class DepthSteadierTest : public testing::Test {
  protected:
    static constexpr int width_px = 81, height_px = 59;
    static constexpr float wall_m = 4, square_m = 2;
    const cv::Rect strip{4, 20, 5, 20};

    DepthImage next(const DepthView& view) {
        view_.upload(view);
        colour_steadier_.steady(view_);
        steadier_.steady(view_);
        const cv::Mat downloaded = view_.steady_depth().download();
        DepthImage depth_m;
        cv::extractChannel(downloaded, depth_m, 0);
        return depth_m(strip);
    }
    DepthView film(float strip_m, double square_x_m = 0) const {
        DepthView view = wall_and_square(0, width_px, height_px, {.square_x_m = square_x_m});
        view.baseline_m = 0.2;
        view.depth_m(strip) = strip_m;
        return view;
    }
    static double furthest(const DepthImage& depth_m, float from_m) {
        return cv::norm(depth_m, DepthImage(depth_m.size(), from_m), cv::NORM_INF);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    DepthSteadier steadier_{shaders_};
    ColourSteadier colour_steadier_{shaders_};
    RigHistory view_;
};

TEST_F(DepthSteadierTest, AveragesWhatStaysWithinItsUncertainty) {
    (void)next(film(wall_m));
    const DepthImage steady = next(film(1.01f * wall_m));
    EXPECT_GT(steady(2, 2), wall_m);
    EXPECT_LT(steady(2, 2), 1.005f * wall_m);
}

TEST_F(DepthSteadierTest, KeepsItsDepthWhereNothingMovesThoughAMatcherWavers) {
    for (int i = 0; i < 4; ++i) (void)next(film(wall_m));
    // A matcher that takes a strip beside the square for the square more often than not.
    for (int i = 0; i < 30; ++i)
        EXPECT_LT(furthest(next(film(i % 4 == 0 ? wall_m : square_m)), wall_m), 1e-3) << i;
}

TEST_F(DepthSteadierTest, FollowsADepthThatHasChangedForGoodWithinFifteenInstants) {
    for (int i = 0; i < 20; ++i) (void)next(film(wall_m));
    for (int i = 0; i < 14; ++i) EXPECT_LT(furthest(next(film(square_m)), wall_m), 1e-3) << i;
    EXPECT_LT(furthest(next(film(square_m)), square_m), 1e-3);
}

TEST_F(DepthSteadierTest, SeldomFollowsAMatcherThatFindsAnotherDepthEveryTime) {
    int changes = 0;
    float before = 0;
    for (int i = 0; i < 60; ++i) {
        const float now = next(film(static_cast<float>(2 + 0.5 * (i % 7))))(2, 2);
        if (i >= 30 && std::abs(now / before - 1) > 0.05f) ++changes;
        before = now;
    }
    EXPECT_LE(changes, 2);
}

TEST_F(DepthSteadierTest, FollowsSoonerWhatIsHardlySettled) {
    (void)next(film(wall_m));
    (void)next(film(square_m));
    EXPECT_LT(furthest(next(film(square_m)), square_m), 1e-3);
}

TEST_F(DepthSteadierTest, FollowsAtOnceWhereThePictureChanges) {
    for (int i = 0; i < 9; ++i) (void)next(film(wall_m));
    // The square has come to where the strip was.
    EXPECT_LT(furthest(next(film(square_m, -0.9)), square_m), 1e-3);
}

/// What the rigs decide together wavers as well, though each rig's own depth does not.
TEST_F(DepthSteadierTest, KeepsTheDrawnSurfaceLikewise) {
    const auto surface_after = [&](float drawn_m) {
        (void)next(film(wall_m));
        const auto surface = std::make_shared<RigSurface>();
        surface->begin(view_.camera(), view_.colour().size(), view_.depth().size(),
                       view_.samples());
        surface->depth_target().bind();
        glClearColor(drawn_m, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT);
        steadier_.settle(view_, *surface);
        view_.publish(surface, 0);
        const cv::Mat downloaded = surface->depth().download();
        DepthImage depth_m;
        cv::extractChannel(downloaded, depth_m, 0);
        return depth_m;
    };
    for (int i = 0; i < 20; ++i) (void)surface_after(wall_m);
    // A guess is another depth than a measured one, and so is none at all.
    for (const float drawn_m : {-wall_m, wall_m, square_m, wall_m, 0.0f, wall_m})
        EXPECT_LT(furthest(surface_after(drawn_m), wall_m), 1e-3) << drawn_m;
    for (int i = 0; i < 14; ++i) EXPECT_LT(furthest(surface_after(square_m), wall_m), 1e-3) << i;
    EXPECT_LT(furthest(surface_after(square_m), square_m), 1e-3);
}

}  // namespace
}  // namespace vantage
