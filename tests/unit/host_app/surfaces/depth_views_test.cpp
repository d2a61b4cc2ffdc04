#include <gtest/gtest.h>

#include "host_app/views/depth_view.h"

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

TEST(DisparityScale, MatchesTheGeometryForEveryDisparity) {
    const DisparityScale scale(geometry(), 62);
    EXPECT_EQ(scale.depth_m(0), 0) << "unknown";
    EXPECT_EQ(scale.depth_m(2 * 32), 0) << "at infinity";
    EXPECT_EQ(scale.depth_m(1 * 32), 0) << "beyond it";
    for (int steps = 2 * 32 + 1; steps < 65536; ++steps) {
        const double expected = geometry().depth_m(steps / 32.0);
        EXPECT_NEAR(scale.depth_m(static_cast<std::uint16_t>(steps)), expected,
                    1e-5 * std::max(1.0, expected))
            << steps;
    }
}

TEST(DisparityScale, ScalesTheDisparitiesOfASmallerMap) {
    EXPECT_NEAR(DisparityScale(geometry(), 31).depth_m(5 * 32), geometry().depth_m(10), 1e-6);
}

TEST(DepthViewOf, HasTheFramesGeometryAndSharesItsPicture) {
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
    EXPECT_EQ(view.disparity.data, frame.disparity.data);
    EXPECT_EQ(view.depth_size(), cv::Size(62, 46));
    EXPECT_NEAR(view.depth_m_at(0, 0), 0.75, 1e-6);
}

}  // namespace
}  // namespace vantage
