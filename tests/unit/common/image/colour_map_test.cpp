#include "common/image/colour_map.h"

#include <limits>

#include <gtest/gtest.h>

namespace vantage {
namespace {

cv::Vec4b colour_of(float disparity_px, float min_px, float max_px) {
    return colour_map_disparity(cv::Mat1f(1, 1, disparity_px), min_px, max_px)(0, 0);
}

TEST(ColourMap, NearIsRedAndFarIsBlue) {
    const cv::Vec4b near = colour_of(60, 4, 64), far = colour_of(12, 4, 64);
    EXPECT_GT(near[0], near[2] + 60);
    EXPECT_GT(far[2], far[0] + 60);
    EXPECT_EQ(near[3], 255);
}

TEST(ColourMap, TheUnknownIsBlack) {
    const cv::Vec4b black(0, 0, 0, 255);
    EXPECT_EQ(colour_of(0, 0, 64), black);
    EXPECT_EQ(colour_of(-3, 0, 64), black);
    EXPECT_EQ(colour_of(std::numeric_limits<float>::infinity(), 0, 64), black);
    EXPECT_EQ(colour_of(std::numeric_limits<float>::quiet_NaN(), 0, 64), black);
}

TEST(ColourMap, ClampsToItsRange) {
    EXPECT_EQ(colour_of(500, 4, 64), colour_of(64, 4, 64));
    EXPECT_EQ(colour_of(1, 4, 64), colour_of(4, 4, 64));
    EXPECT_NE(colour_of(1, 4, 64), cv::Vec4b(0, 0, 0, 255)) << "known, though far";
    EXPECT_NO_THROW(colour_of(5, 5, 5)) << "a range without width";
}

TEST(ColourMap, TakesPicturesRowByRow) {
    cv::Mat1f disparity(3, 2);
    disparity << 10, 20, 30, 40, 50, 60;
    const ColourImage picture = colour_map_disparity(disparity, 0, 64);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 2; ++x) EXPECT_EQ(picture(y, x), colour_of(disparity(y, x), 0, 64));
}

TEST(ToFloatPx, CountsThirtySecondsOfAPixel) {
    DisparityImage disparity(1, 4);
    disparity << 0, 1, 80, 65535;
    const cv::Mat1f px = to_float_px(disparity);
    EXPECT_EQ(px(0, 0), 0);
    EXPECT_EQ(px(0, 1), 1.0f / 32);
    EXPECT_EQ(px(0, 2), 2.5f);
    EXPECT_EQ(px(0, 3), max_disparity_px);
}

}  // namespace
}  // namespace vantage
