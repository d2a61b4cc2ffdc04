#include "host_app/foreground/motion/rig_motion.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/unit/host_app/motion/moving_square.h"

namespace vantage {
namespace {

double mean_error(const cv::Mat& a, const cv::Mat& b, const cv::Rect& where) {
    cv::Mat difference;
    cv::absdiff(a(where), b(where), difference);
    const cv::Scalar mean = cv::mean(difference);
    return (mean[0] + mean[1] + mean[2]) / 3;
}

TEST(RigMotionTest, MovesASurfaceHalfWayAtHalfTheTimeWithItsDepth) {
    const RigFrame first = frame_at(50, 1000), second = frame_at(58, 5000);
    const RigFrame truth = frame_at(54, 3000);
    const RigMotion motion = motion_between(first, second);
    ASSERT_FALSE(motion.empty());
    const RigFrame between = frame_between(first, second, motion, 0.5);
    EXPECT_EQ(to_ns(between.exposure), 3000);
    EXPECT_EQ(between.rig, "north");
    const cv::Rect around(40, 30, 70, 60);
    const double moved = mean_error(between.colour, truth.colour, around);
    EXPECT_LT(moved, 0.4 * mean_error(first.colour, truth.colour, around));
    EXPECT_LT(moved,
              0.4 * mean_error(0.5 * first.colour + 0.5 * second.colour, truth.colour, around));
    const cv::Rect inside(58, 44, 32, 32);
    EXPECT_EQ(cv::countNonZero(between.disparity(inside) != near_steps), 0);
    int wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) wrong += between.disparity(y, x) != truth.disparity(y, x);
    EXPECT_LT(wrong, 4 * square * 2) << "but for its rims";
}

TEST(RigMotionTest, KeepsASurfacesWidth) {
    const RigFrame first = frame_at(50, 0), second = frame_at(57, 1000);
    const RigFrame between = frame_between(first, second, motion_between(first, second), 0.5);
    for (int y = height / 2 - 10; y < height / 2 + 10; ++y)
        EXPECT_NEAR(cv::countNonZero(between.disparity.row(y) == near_steps), square, 1) << y;
}

TEST(RigMotionTest, KeepsStillSurfaces) {
    const RigFrame first = frame_at(50, 0), second = frame_at(50, 1000);
    const RigFrame between = frame_between(first, second, motion_between(first, second), 0.5);
    EXPECT_LT(mean_error(between.colour, first.colour, {0, 0, width, height}), 0.5);
    EXPECT_EQ(cv::countNonZero(between.disparity != first.disparity), 0);
}

TEST(RigMotionTest, ReturnsTheFramesAtTheEnds) {
    const RigFrame first = frame_at(50, 0), second = frame_at(58, 1000);
    const RigMotion motion = motion_between(first, second);
    const cv::Rect all(0, 0, width, height);
    EXPECT_LT(mean_error(frame_between(first, second, motion, 0.01).colour, first.colour, all),
              1.5);
    EXPECT_LT(mean_error(frame_between(first, second, motion, 0.99).colour, second.colour, all),
              1.5);
}

TEST(RigMotionTest, IsEmptyForFramesThatCannotBeCompared) {
    const RigFrame first = frame_at(50, 0);
    RigFrame other = frame_at(50, 0);
    other.colour = ColourImage(60, 80);
    EXPECT_TRUE(motion_between(first, other).empty());
    other.colour = ColourImage();
    EXPECT_TRUE(motion_between(first, other).empty());
    EXPECT_TRUE(motion_between(other, other).empty());
}

TEST(RigMotionTest, InterpolatesNoDisparityFromFramesWithout) {
    RigFrame first = frame_at(50, 0), second = frame_at(58, 0);
    first.disparity = second.disparity = DisparityImage();
    const RigFrame between = frame_between(first, second, motion_between(first, second), 0.5);
    EXPECT_TRUE(between.disparity.empty());
    EXPECT_EQ(between.colour.size(), first.colour.size());
}

TEST(RigMotionTest, AllowsDisparityCoarserThanColour) {
    RigFrame first = frame_at(50, 0), second = frame_at(58, 0);
    for (RigFrame* frame : {&first, &second}) {
        cv::Mat coarse;
        cv::resize(frame->disparity, coarse, {width / 2, height / 2}, 0, 0, cv::INTER_NEAREST);
        frame->disparity = DisparityImage(coarse);
    }
    const RigFrame between = frame_between(first, second, motion_between(first, second), 0.5);
    EXPECT_EQ(between.disparity.size(), cv::Size(width / 2, height / 2));
    EXPECT_EQ(between.disparity(height / 4, (54 + square / 2) / 2), near_steps);
    EXPECT_EQ(between.disparity(2, 2), far_steps);
}

}  // namespace
}  // namespace vantage
