#include "host_app/programme/coarse_depth.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"

namespace vantage {
namespace {

class CoarseDepthTest : public testing::Test {
  protected:
    cv::Mat1f coarse(const cv::Mat1f& depth_m) {
        Texture texture(TextureFormat::r32f, depth_m.cols, depth_m.rows);
        texture.upload(depth_m);
        grid_.begin(texture);
        return grid_.take();
    }

    EglContext context_;
    ShaderLibrary library_;
    CoarseDepth grid_{library_};
};

TEST_F(CoarseDepthTest, KeepsTheNearestDepthOfACell) {
    cv::Mat1f depth_m(4, 320, 8.0f);
    depth_m(1, 3) = 2;
    depth_m(2, 319) = -4;  // the magnitude counts
    const cv::Mat1f grid = coarse(depth_m);
    ASSERT_EQ(grid.size(), cv::Size(160, 2));
    EXPECT_FLOAT_EQ(grid(0, 0), 0.125f);
    EXPECT_FLOAT_EQ(grid(0, 1), 0.5f);
    EXPECT_FLOAT_EQ(grid(1, 159), 0.25f);
}

TEST_F(CoarseDepthTest, CellsWithoutASurfaceAreZero) {
    cv::Mat1f depth_m = cv::Mat1f::zeros(6, 640);
    depth_m(0, 0) = 5;
    const cv::Mat1f grid = coarse(depth_m);
    ASSERT_EQ(grid.size(), cv::Size(160, 1));
    EXPECT_FLOAT_EQ(grid(0, 0), 0.2f);
    EXPECT_EQ(grid(0, 1), 0);
}

TEST_F(CoarseDepthTest, KeepsSmallFramesAtFullSize) {
    cv::Mat1f depth_m(3, 5, 4.0f);
    depth_m(2, 4) = 10;
    const cv::Mat1f grid = coarse(depth_m);
    ASSERT_EQ(grid.size(), depth_m.size());
    EXPECT_FLOAT_EQ(grid(2, 4), 0.1f);
    EXPECT_FLOAT_EQ(grid(0, 0), 0.25f);
}

}  // namespace
}  // namespace vantage
