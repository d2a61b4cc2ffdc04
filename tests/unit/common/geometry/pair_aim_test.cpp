#include "common/geometry/pair_aim.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double radians = 0.017453292519943295;

/// Two cameras with 56 degrees of view, this far apart, each turned inwards by half of the angle.
StereoCalibration toed_in(double baseline_m, double angle_deg, double roll_deg = 0) {
    StereoCalibration c;
    c.left.width_px = c.right.width_px = 640;
    c.left.height_px = c.right.height_px = 480;
    for (CameraModel* camera : {&c.left, &c.right}) {
        camera->fx_px = camera->fy_px = 600;
        camera->cx_px = 319.5;
        camera->cy_px = 239.5;
        camera->distortion = {-0.1, 0.02, 0, 0, 0};
    }
    const auto turned = [&](double x, double degrees) {
        Pose pose = Pose::Identity();
        pose.linear() =
            Eigen::AngleAxisd(degrees * radians, Eigen::Vector3d::UnitY()).toRotationMatrix();
        pose.translation() = Eigen::Vector3d(x, 0, 0);
        return pose;
    };
    Pose right = turned(baseline_m / 2, -angle_deg / 2);
    right.linear() =
        right.linear() * Eigen::AngleAxisd(-roll_deg * radians, Eigen::Vector3d::UnitZ());
    c.right_from_left = right.inverse() * turned(-baseline_m / 2, angle_deg / 2);
    compute_rectification(c, 0);
    return c;
}

/// A point of the middle between the cameras, in both rectified images.
std::pair<Eigen::Vector2d, Eigen::Vector2d> seen(const StereoCalibration& c, double depth_m) {
    const Eigen::Vector3d in_rectified(c.rectified.baseline_m / 2, 0.1, depth_m);
    const Eigen::Vector3d other = in_rectified - Eigen::Vector3d(c.rectified.baseline_m, 0, 0);
    const auto pixel = [&](const Eigen::Vector3d& p, double cx) {
        return Eigen::Vector2d(c.rectified.f_px * p.x() / p.z() + cx,
                               c.rectified.f_px * p.y() / p.z() + c.rectified.cy_px);
    };
    return {pixel(in_rectified, c.rectified.cx_left_px), pixel(other, c.rectified.cx_right_px)};
}

TEST(PairAim, MeasuresToeInCrossingAndRoll) {
    const PairAim aim = aim_of(toed_in(0.5, 20));
    EXPECT_NEAR(aim.toe_in_deg, 20, 1e-6);
    EXPECT_NEAR(aim.crossing_m, 0.25 / std::tan(10 * radians), 1e-6);
    EXPECT_NEAR(aim.roll_deg, 0, 1e-6);
    EXPECT_NEAR(std::abs(aim_of(toed_in(0.5, 0, 4)).roll_deg), 4, 1e-6);
    EXPECT_EQ(aim_of(toed_in(0.5, -10)).crossing_m, 0) << "turned apart";
}

TEST(PairAim, SharesTheViewWhereTheAxesCross) {
    const StereoCalibration c = toed_in(0.5, 20);
    EXPECT_GT(shared_view(c, aim_of(c).crossing_m), 0.85);
    EXPECT_LT(shared_view(c, infinity), 0.7);
    EXPECT_GT(shared_view(toed_in(0.1, 0), infinity), 0.95);
}

TEST(PairAim, KeepsTheMiddleOfToedInCamerasInThePictures) {
    StereoCalibration c = toed_in(0.5, 20);
    const double at_infinity_f = c.rectified.f_px;
    const double far_m = suitable_far_m(c);
    EXPECT_NEAR(far_m, 2 * aim_of(c).crossing_m, 1e-9);
    compute_rectification_to(c, 0, far_m);
    c.validate();
    EXPECT_LT(c.rectified.f_px, 0.85 * at_infinity_f) << "less of the pictures is cut off";
    EXPECT_NEAR(farthest_m(c.rectified), far_m, 1e-9);
    for (const double depth_m : {1.0, 1.5, far_m}) {
        const auto [left, right] = seen(c, depth_m);
        EXPECT_NEAR(left.x() - right.x(), c.rectified.disparity_px(depth_m), 1e-9);
        EXPECT_NEAR(left.y(), right.y(), 1e-9);
        EXPECT_TRUE(left.x() > 0 && left.x() < 639 && right.x() > 0 && right.x() < 639) << depth_m;
    }
    EXPECT_NEAR(c.rectified.disparity_px(far_m), 0, 1e-9);
}

TEST(PairAim, ShowsValidPixelsOnlyAtAlphaZeroAndAllAtOne) {
    for (const double alpha : {0.0, 1.0}) {
        StereoCalibration c = toed_in(0.5, 20);
        compute_rectification_to(c, alpha, 2.5);
        for (const bool is_left : {true, false}) {
            const CameraModel& camera = is_left ? c.left : c.right;
            const Eigen::Matrix3d& rotation =
                is_left ? c.rectified_from_left : c.rectified_from_right;
            const double cx = is_left ? c.rectified.cx_left_px : c.rectified.cx_right_px;
            for (const double x : {0.0, 319.5, 639.0})
                for (const double y : {0.0, 239.5, 479.0}) {
                    const auto raw = camera.project(
                        rotation.transpose() *
                        Eigen::Vector3d((x - cx) / c.rectified.f_px,
                                        (y - c.rectified.cy_px) / c.rectified.f_px, 1));
                    const bool is_inside = raw && raw->x() > -0.5 && raw->x() < 639.5 &&
                                           raw->y() > -0.5 && raw->y() < 479.5;
                    EXPECT_TRUE(is_inside || alpha == 1) << x << ' ' << y;
                    const Eigen::Vector3d ray = rotation * camera.unproject({x, y});
                    const double u = c.rectified.f_px * ray.x() / ray.z() + cx;
                    EXPECT_TRUE((u > -0.5 && u < 639.5) || alpha == 0) << x << ' ' << y;
                }
        }
    }
}

TEST(PairAim, LeavesParallelCamerasAsTheyAre) {
    StereoCalibration c = toed_in(0.1, 2);
    EXPECT_TRUE(std::isinf(suitable_far_m(c)));
    const RectifiedStereo before = c.rectified;
    compute_rectification_to(c, 0, suitable_far_m(c));
    EXPECT_EQ(c.rectified.f_px, before.f_px);
    EXPECT_EQ(c.rectified.doffs_px(), 0);
    EXPECT_TRUE(std::isinf(farthest_m(c.rectified)));
}

TEST(PairAim, RefusesADistanceAtWhichNothingIsShared) {
    StereoCalibration c = toed_in(2.5, 42);
    EXPECT_NE(thrown_sentence([&] { compute_rectification_to(c, 0, 0.5); }).find("--far-m"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
