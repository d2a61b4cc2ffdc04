#include "host_app/desk/feed/rig_pictures.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// Depths from 2 m at the left to 8 m at the right.
DepthImage ramp() {
    DepthImage depth(4, 101);
    for (int y = 0; y < depth.rows; ++y)
        for (int x = 0; x < depth.cols; ++x) depth(y, x) = 2 + 0.06f * static_cast<float>(x);
    return depth;
}
int brightness(const cv::Vec4b& c) { return c[0] + c[1] + c[2]; }

TEST(DepthColoursTest, UseTheWholeRangeOfTheScene) {
    DepthRange range;
    range.follow(ramp());
    EXPECT_NEAR(range.nearest_m, 2.12, 0.07);
    EXPECT_NEAR(range.farthest_m, 7.88, 0.07);
    const ColourImage picture = depth_colours(ramp(), range);
    EXPECT_GT(brightness(picture(0, 0)), 500) << "the nearest is bright";
    EXPECT_LT(brightness(picture(0, 100)), 160) << "the farthest is dark";
    for (int x = 10; x <= 90; x += 10)
        EXPECT_LT(brightness(picture(0, x)), brightness(picture(0, x - 10))) << x;
}

TEST(DepthColoursTest, UnknownDepthsAreBlackAndOutsideTheRange) {
    DepthImage depth = ramp();
    depth.row(0).setTo(0);
    DepthRange range;
    range.follow(depth);
    EXPECT_NEAR(range.nearest_m, 2.12, 0.07);
    EXPECT_EQ(depth_colours(depth, range)(0, 50), cv::Vec4b(0, 0, 0, 255));
}

TEST(DepthColoursTest, AFewWildPixelsDoNotWidenTheRange) {
    DepthImage depth = ramp();
    depth(0, 0) = 0.01f;
    depth(1, 1) = 900;
    DepthRange range;
    range.follow(depth);
    EXPECT_GT(range.nearest_m, 2);
    EXPECT_LT(range.farthest_m, 8);
}

TEST(DepthColoursTest, TheRangeFollowsSlowly) {
    DepthRange range;
    range.follow(DepthImage(4, 4, 2.0f));
    range.follow(DepthImage(4, 4, 4.0f));
    EXPECT_GT(range.nearest_m, 2.0);
    EXPECT_LT(range.nearest_m, 2.5);
    for (int i = 0; i < 100; ++i) range.follow(DepthImage(4, 4, 4.0f));
    EXPECT_NEAR(range.nearest_m, 4, 0.01);
    const DepthRange before = range;
    range.follow(DepthImage(4, 4, 0.0f));
    EXPECT_EQ(range.nearest_m, before.nearest_m) << "a frame without depth changes nothing";
}

TEST(DepthColoursTest, DepthUsesTheWidthOfTheDisparityImage) {
    RectifiedStereo geometry;
    geometry.f_px = 100;
    geometry.baseline_m = 0.2;
    geometry.width_px = 2;
    const DisparityScale scale(geometry, 2);
    const DisparityImage disparity(1, 2, static_cast<unsigned short>(5 * disparity_steps_per_px));
    EXPECT_NEAR(depth_of(disparity, scale)(0, 0), 4, 1e-5);
    EXPECT_EQ(depth_of(DisparityImage::zeros(1, 2), scale)(0, 1), 0);
}

}  // namespace
}  // namespace vantage
