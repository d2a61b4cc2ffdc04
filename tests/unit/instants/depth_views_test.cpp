#include "host_app/instants/depth_views.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

RectifiedStereo geometry() {
    RectifiedStereo g;
    g.width_px = 62;
    g.height_px = 46;
    g.f_px = 60;
    g.cx_left_px = 30;
    g.cx_right_px = 28;  // doffs -2
    g.cy_px = 22;
    g.baseline_m = 0.1;
    return g;
}

TEST(DepthFromDisparity, AgreesWithTheGeometryAtEveryStep) {
    DisparityImage disparity(46, 62);
    for (int i = 0; i < 46 * 62; ++i) disparity(i / 62, i % 62) = static_cast<unsigned short>(i);
    const DepthImage depth_m = depth_from_disparity(disparity, geometry());
    for (int y = 0; y < 46; ++y)
        for (int x = 0; x < 62; ++x) {
            const int steps = disparity(y, x);
            const double expected = steps == 0 ? 0 : geometry().depth_m(steps / 32.0);
            EXPECT_NEAR(depth_m(y, x), expected, 1e-5 * std::max(1.0, expected)) << steps;
        }
}

TEST(DepthFromDisparity, BringsASmallerMapToTheColoursPixels) {
    const DisparityImage half(23, 31, static_cast<unsigned short>(5 * 32));
    const DepthImage depth_m = depth_from_disparity(half, geometry());
    ASSERT_EQ(depth_m.size(), half.size());
    EXPECT_NEAR(depth_m(7, 9), geometry().depth_m(10), 1e-6);
}

TEST(DepthViewOf, TakesOverTheFramesGeometryAndSharesItsPicture) {
    RigFrame frame;
    frame.rig = "north";
    frame.geometry = geometry();
    frame.world_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
    frame.colour = ColourImage(46, 62, cv::Vec4b(1, 2, 3, 255));
    frame.disparity = DisparityImage(46, 62, static_cast<unsigned short>(320));
    const DepthView view = depth_view_of(frame);
    EXPECT_EQ(view.name, "north");
    EXPECT_EQ(view.colour.data, frame.colour.data);
    EXPECT_EQ(view.K, geometry().K_left());
    EXPECT_EQ(view.world_from_camera.translation(), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(view.baseline_m, 0.1);
    EXPECT_EQ(view.doffs_px, -2);
    EXPECT_NEAR(view.depth_m(0, 0), 0.75, 1e-6);
}

}  // namespace
}  // namespace vantage
