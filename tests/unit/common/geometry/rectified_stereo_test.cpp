#include "common/geometry/rectified_stereo.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

RectifiedStereo geometry(double cx_right_px) {
    RectifiedStereo g;
    g.width_px = 640;
    g.height_px = 480;
    g.f_px = 500;
    g.cx_left_px = 320;
    g.cx_right_px = cx_right_px;
    g.cy_px = 240;
    g.baseline_m = 0.12;
    return g;
}

TEST(RectifiedStereo, DepthAndDisparityAreInverse) {
    for (const double cx_right : {320.0, 352.5, 301.0}) {
        const RectifiedStereo g = geometry(cx_right);
        for (const double depth_m : {0.4, 1.0, 3.7, 25.0}) {
            const double disparity = g.disparity_px(depth_m);
            EXPECT_NEAR(g.depth_m(disparity), depth_m, 1e-9 * depth_m);
            // As the pictures have it: where a point on the axis of the left camera falls.
            const double x_right = g.f_px * (0 - g.baseline_m) / depth_m + g.cx_right_px;
            EXPECT_NEAR(g.cx_left_px - disparity, x_right, 1e-9);
        }
    }
}

TEST(RectifiedStereo, DepthIsUnknownAtAndBeyondInfinity) {
    const RectifiedStereo g = geometry(352.5);  // doffs 32.5
    EXPECT_EQ(g.depth_m(-32.5), 0);
    EXPECT_EQ(g.depth_m(-40), 0);
    EXPECT_GT(g.depth_m(-32), 0) << "offset pictures know depth at negative disparity";
    EXPECT_EQ(geometry(320).depth_m(0), 0);
}

TEST(RectifiedStereo, ReturnsKOfTheLeftImage) {
    Eigen::Matrix3d expected;
    expected << 500, 0, 320, 0, 500, 240, 0, 0, 1;
    EXPECT_EQ(geometry(352.5).K_left(), expected);
}

}  // namespace
}  // namespace vantage
