#include <vector>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/refine/multi_view_refinement.h"
#include "host_app/surfaces/rig_history.h"
#include "tests/unit/host_app/fused/wall_and_square.h"

namespace vantage {
namespace {

constexpr int sweep_width_px = 129, sweep_height_px = 95;
constexpr float wall_m = 4;
/// A region that all rigs see, away from the borders of their pictures.
const cv::Rect middle(35, 25, 60, 45);

/// A rig between two others before a wall, whose depth has the same error everywhere.
class DepthSweepTest : public testing::Test {
  protected:
    static DepthView film(double x_m, bool is_patterned) {
        DepthView view = wall_and_square(x_m, sweep_width_px, sweep_height_px,
                                         {.square_x_m = 100, .waves = is_patterned});
        view.baseline_m = 0.05;
        if (!is_patterned) view.colour.setTo(cv::Scalar(90, 120, 150, 255));
        return view;
    }
    DepthImage swept(float error, bool is_patterned) {
        std::vector<DepthView> rigs{film(0, is_patterned), film(-1, is_patterned),
                                    film(1, is_patterned)};
        rigs[0].depth_m *= 1 + error;
        RigRoster views;
        views.upload(rigs, nominal_dt_s);
        return DepthImage(
            refinement_.refine(compared(*views.shown()[0]), compared(views.shown())).download())(
            middle);
    }
    /// The mean relative error.
    static double error_of(const DepthImage& depth_m) {
        return cv::mean(cv::Mat(cv::abs(depth_m - wall_m)))[0] / wall_m;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    MultiViewRefinement refinement_{shaders_};
};

/// The others stand 1 m aside: 4 % of depth is a pixel of their 26 px of parallax.
TEST_F(DepthSweepTest, MovesDepthToWhereThePicturesMatch) {
    for (const float error : {-0.04f, 0.04f})
        EXPECT_LT(error_of(swept(error, true)), 0.01) << error;
}

TEST_F(DepthSweepTest, MovesNothingOnAPlainSurface) {
    EXPECT_NEAR(error_of(swept(0.04f, false)), 0.04, 1e-6);
}

TEST_F(DepthSweepTest, MovesNothingThatIsConsistentWithinAPixel) {
    EXPECT_NEAR(error_of(swept(0.02f, true)), 0.02, 1e-6);
}

}  // namespace
}  // namespace vantage
