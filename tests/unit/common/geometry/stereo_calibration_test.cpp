#include "common/geometry/stereo_calibration.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/geometry/rectification_map.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Two unlike cameras, the right one turned and shifted a little in every direction.
StereoCalibration crooked_rig(LensModel lens) {
    StereoCalibration c;
    c.left.width_px = c.right.width_px = 320;
    c.left.height_px = c.right.height_px = 240;
    c.left.fx_px = c.left.fy_px = 260;
    c.left.cx_px = 161.5;
    c.left.cy_px = 118.25;
    c.left.skew_px = 0.7;
    c.right = c.left;
    c.right.fx_px = 266;
    c.right.fy_px = 264;
    c.right.cy_px = 121;
    c.left.lens = c.right.lens = lens;
    if (lens == LensModel::pinhole) {
        c.left.distortion = {-0.21, 0.05, 0.001, -0.0005, 0.002};
        c.right.distortion = {-0.19, 0.04, -0.0004, 0.0008, 0.001};
    } else {
        c.left.distortion = {0.03, -0.004, 0.001, 0};
        c.right.distortion = {0.028, -0.003, 0.0008, 0};
    }
    c.right_from_left = Eigen::AngleAxisd(0.04, Vector3d(0.3, 0.8, -0.5).normalized()) *
                        Eigen::Translation3d(-0.15, 0.004, -0.006);
    c.world_from_left = look_at({1, 2, 3}, {0, 1, 0});
    return c;
}

std::vector<Vector3d> points_before_the_rig() {
    std::vector<Vector3d> points;
    for (double z : {1.2, 3.0, 9.0})
        for (double x : {-0.35, 0.0, 0.3})
            for (double y : {-0.25, 0.02, 0.22}) points.emplace_back(x * z, y * z, z);
    return points;
}

/// Where a point in front of the rectified left camera falls in a rectified picture.
Vector2d rectified_pixel(const StereoCalibration& c, const Vector3d& in_left, Side side) {
    const bool is_left = side == Side::left;
    const Vector3d p = is_left ? Vector3d(c.rectified_from_left * in_left)
                               : Vector3d(c.rectified_from_right * (c.right_from_left * in_left));
    return {c.rectified.f_px * p.x() / p.z() +
                (is_left ? c.rectified.cx_left_px : c.rectified.cx_right_px),
            c.rectified.f_px * p.y() / p.z() + c.rectified.cy_px};
}

class Rectification : public testing::TestWithParam<LensModel> {
  protected:
    Rectification() : calibration_(crooked_rig(GetParam())) {
        compute_rectification(calibration_, 0);
        calibration_.validate();
    }
    StereoCalibration calibration_;
};

TEST_P(Rectification, PutsEveryPointOnOneRowAtTheDisparityOfItsDepth) {
    EXPECT_NEAR(calibration_.rectified.baseline_m,
                calibration_.right_from_left.translation().norm(), 1e-9);
    EXPECT_EQ(calibration_.rectified.doffs_px(), 0) << "zero disparity at infinity";
    for (const Vector3d& point : points_before_the_rig()) {
        const Vector2d left = rectified_pixel(calibration_, point, Side::left),
                       right = rectified_pixel(calibration_, point, Side::right);
        EXPECT_NEAR(left.y(), right.y(), 1e-6);
        const double depth_m = (calibration_.rectified_from_left * point).z();
        EXPECT_NEAR(left.x() - right.x(), calibration_.rectified.disparity_px(depth_m), 1e-6);
    }
}

TEST_P(Rectification, MapsPointToWhereTheRawCamerasSeeThem) {
    for (const Side side : {Side::left, Side::right}) {
        const bool is_left = side == Side::left;
        const cv::Mat2f map = make_rectification_map(calibration_, side);
        const RectifiedStereo& r = calibration_.rectified;
        ASSERT_EQ(map.size(), cv::Size(r.width_px, r.height_px));
        const Eigen::Matrix3d& rotation =
            is_left ? calibration_.rectified_from_left : calibration_.rectified_from_right;
        const CameraModel& camera = is_left ? calibration_.left : calibration_.right;
        for (int y = 0; y < map.rows; y += 17)
            for (int x = 0; x < map.cols; x += 19) {
                const Vector3d ray((x - (is_left ? r.cx_left_px : r.cx_right_px)) / r.f_px,
                                   (y - r.cy_px) / r.f_px, 1);
                const auto raw = camera.project(rotation.transpose() * ray);
                ASSERT_TRUE(raw);
                EXPECT_NEAR(map(y, x)[0], raw->x(), 2e-4);
                EXPECT_NEAR(map(y, x)[1], raw->y(), 2e-4);
            }
    }
}

TEST_P(Rectification, OnlyValidPixelsAreShownAtAlphaZero) {
    for (const Side side : {Side::left, Side::right}) {
        const cv::Mat2f map = make_rectification_map(calibration_, side);
        int outside = 0;
        for (const auto& p : map) outside += p[0] < -1 || p[1] < -1 || p[0] > 320 || p[1] > 240;
        EXPECT_LT(outside, static_cast<int>(map.total()) / 100);
    }
}

TEST_P(Rectification, RemappedPicturesShowTheSceneFromTheRectifiedCamera) {
    // A far pattern that depends on direction alone: smooth, and different everywhere.
    const auto brightness = [](const Vector3d& direction) {
        const Vector3d d = direction / direction.z();
        return static_cast<float>(100 + 40 * std::sin(7 * d.x()) + 40 * std::cos(9 * d.y() + 2));
    };
    for (const Side side : {Side::left, Side::right}) {
        const bool is_left = side == Side::left;
        const CameraModel& camera = is_left ? calibration_.left : calibration_.right;
        const Eigen::Matrix3d& rotation =
            is_left ? calibration_.rectified_from_left : calibration_.rectified_from_right;
        cv::Mat1f raw(camera.height_px, camera.width_px);
        for (int y = 0; y < raw.rows; ++y)
            for (int x = 0; x < raw.cols; ++x)
                raw(y, x) = brightness(rotation * camera.unproject(Vector2d(x, y)));
        cv::Mat1f rectified;
        cv::remap(raw, rectified, make_rectification_map(calibration_, side), cv::noArray(),
                  cv::INTER_LINEAR);
        const RectifiedStereo& r = calibration_.rectified;
        for (int y = 5; y < rectified.rows - 5; ++y)
            for (int x = 5; x < rectified.cols - 5; ++x) {
                const Vector3d ray((x - (is_left ? r.cx_left_px : r.cx_right_px)) / r.f_px,
                                   (y - r.cy_px) / r.f_px, 1);
                ASSERT_NEAR(rectified(y, x), brightness(ray), 0.25) << x << ", " << y;
            }
    }
}

TEST_P(Rectification, ChoosesTheSizeAskedFor) {
    StereoCalibration small = crooked_rig(GetParam());
    small.rectified.width_px = 160;
    small.rectified.height_px = 120;
    compute_rectification(small, 0);
    EXPECT_EQ(make_rectification_map(small, Side::left).size(), cv::Size(160, 120));
    EXPECT_NEAR(small.rectified.f_px, 0.5 * calibration_.rectified.f_px,
                0.03 * calibration_.rectified.f_px);
}

TEST_P(Rectification, ComputesThePoseOfTheRectifiedView) {
    const Pose expected = calibration_.world_from_left;
    const Vector3d point(0.2, -0.1, 2);
    const Vector3d in_rectified = calibration_.rectified_from_left * point;
    EXPECT_LT((calibration_.world_from_rectified_left() * in_rectified - expected * point).norm(),
              1e-12);
}

TEST_P(Rectification, AssumedPoseIsLevelAtEyeHeight) {
    assume_place(calibration_);
    EXPECT_TRUE(calibration_.place_is_assumed);
    const Pose place = calibration_.world_from_rectified_left();
    const double half_m = 0.5 * calibration_.rectified.baseline_m;
    EXPECT_LT((place * Vector3d(half_m, 0, 0) - Vector3d(0, 1.6, 0)).norm(), 1e-12);
    EXPECT_LT((place.linear() * Vector3d::UnitX() - Vector3d::UnitX()).norm(), 1e-12);
    EXPECT_LT((place.linear() * Vector3d::UnitY() + Vector3d::UnitY()).norm(), 1e-12);
    EXPECT_LT((place.linear() * Vector3d::UnitZ() + Vector3d::UnitZ()).norm(), 1e-12);
    EXPECT_NO_THROW(calibration_.validate());
}

INSTANTIATE_TEST_SUITE_P(Lenses, Rectification,
                         testing::Values(LensModel::pinhole, LensModel::fisheye));

TEST(ComputeRectification, NoticesSwappedAndMixedCameras) {
    StereoCalibration swapped = crooked_rig(LensModel::pinhole);
    swapped.right_from_left = swapped.right_from_left.inverse();
    EXPECT_NE(
        thrown_sentence([&] { compute_rectification(swapped, 0); }).find("swap left and right"),
        std::string::npos);
    StereoCalibration mixed = crooked_rig(LensModel::pinhole);
    mixed.right.lens = LensModel::fisheye;
    mixed.right.distortion.resize(4);
    EXPECT_NE(thrown_sentence([&] { compute_rectification(mixed, 0); }).find("lenses of one model"),
              std::string::npos);
}

TEST(RectifiedCalibration, IsAnIdentityWithoutDistortion) {
    RectifiedStereo geometry;
    geometry.width_px = 64;
    geometry.height_px = 48;
    geometry.f_px = 60;
    geometry.cx_left_px = 31;
    geometry.cx_right_px = 33;
    geometry.cy_px = 24;
    geometry.baseline_m = 0.1;
    const StereoCalibration ideal = rectified_calibration(geometry);
    ideal.validate();
    for (const Side side : {Side::left, Side::right}) {
        EXPECT_TRUE(is_identity(ideal, side));
        const cv::Mat2f map = make_rectification_map(ideal, side);
        for (int y = 0; y < map.rows; ++y)
            for (int x = 0; x < map.cols; ++x) {
                EXPECT_NEAR(map(y, x)[0], x, 1e-4);
                EXPECT_NEAR(map(y, x)[1], y, 1e-4);
            }
    }
    StereoCalibration bent = ideal;
    bent.left.distortion = {0, 0, 0, 0};
    EXPECT_TRUE(is_identity(bent, Side::left)) << "zeros bend nothing";
    bent.left.distortion = {0.01, 0, 0, 0};
    EXPECT_FALSE(is_identity(bent, Side::left));
    EXPECT_TRUE(is_identity(bent, Side::right));
    bent = ideal;
    bent.right.cx_px += 0.5;
    EXPECT_FALSE(is_identity(bent, Side::right));
    bent = ideal;
    bent.left.lens = LensModel::fisheye;
    EXPECT_FALSE(is_identity(bent, Side::left));
}

TEST(StereoCalibration, RefusesInvalidValues) {
    const auto refusal = [](auto change) {
        StereoCalibration c = crooked_rig(LensModel::pinhole);
        compute_rectification(c, 0);
        change(c);
        return thrown_sentence([&] { c.validate(); });
    };
    EXPECT_EQ(refusal([](StereoCalibration&) {}), "");
    EXPECT_NE(refusal([](auto& c) { c.rectified.baseline_m = -0.1; }).find("swapped"),
              std::string::npos);
    EXPECT_NE(refusal([](auto& c) { c.rectified.baseline_m = NAN; }).find("baseline"),
              std::string::npos);
    EXPECT_NE(refusal([](auto& c) { c.rectified.f_px = 0; }).find("focal length"),
              std::string::npos);
    EXPECT_NE(refusal([](auto& c) { c.rectified.width_px = 0; }).find("0x240"), std::string::npos);
    EXPECT_NE(refusal([](auto& c) { c.rectified.cy_px = INFINITY; }).find("principal"),
              std::string::npos);
    EXPECT_NE(refusal([](auto& c) { c.rectified_from_left *= 1.01; }).find("rectified_from_left"),
              std::string::npos);
    EXPECT_NE(refusal([](auto& c) {
                  c.right_from_left.linear().col(0) *= -1;
              }).find("right_from_left is not a rotation"),
              std::string::npos)
        << "a mirror image";
    EXPECT_NE(refusal([](auto& c) { c.world_from_left.translation().y() = NAN; }).find("finite"),
              std::string::npos);
    EXPECT_NE(refusal([](auto& c) { c.left.fx_px = 0; }).find("focal"), std::string::npos);
}

}  // namespace
}  // namespace vantage
