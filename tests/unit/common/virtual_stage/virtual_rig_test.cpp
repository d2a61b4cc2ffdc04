#include "common/virtual_stage/virtual_rig.h"

#include <chrono>
#include <cmath>
#include <tuple>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/geometry/rectification_map.h"
#include "common/gl/context/egl_context.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;

VirtualRigPlacement small_placement() {
    VirtualRigPlacement placement;
    placement.azimuth_rad = 0.4;
    placement.width_px = 161;
    placement.height_px = 119;
    return placement;
}

double psnr_db(const ColourImage& a, const ColourImage& b) {
    cv::Mat difference;
    cv::absdiff(a, b, difference);
    difference.convertTo(difference, CV_32F);
    const double sum = cv::norm(difference, cv::NORM_L2SQR);
    return 10 * std::log10(255.0 * 255.0 * 3 * static_cast<double>(a.total()) / sum);
}

class VirtualRigTest : public testing::Test {
  protected:
    EglContext context_;
    ShaderLibrary library_;
};

TEST(VirtualRigPlacementTest, IsPlacedAndLooksAtThePivot) {
    const VirtualRigPlacement p = small_placement();
    const StereoCalibration c = ideal_virtual_rig(p);
    c.validate();
    const Pose world_from_right = c.world_from_left * c.right_from_left.inverse();
    const Vector3d left = c.world_from_left.translation(), right = world_from_right.translation();
    const Vector3d middle = 0.5 * (left + right), pivot(0, 1, 0);
    EXPECT_NEAR((right - left).norm(), p.baseline_m, 1e-12);
    EXPECT_NEAR((middle - pivot).norm(), p.distance_m, 1e-12);
    EXPECT_NEAR(std::atan2(middle.x(), middle.z()), p.azimuth_rad, 1e-12);
    EXPECT_NEAR(std::asin((middle.y() - 1) / p.distance_m), p.elevation_rad, 1e-12);
    EXPECT_NEAR((right - left).y(), 0, 1e-12) << "the baseline is level";

    const auto in_left = c.left.project(c.world_from_left.inverse() * pivot);
    const auto in_right = c.right.project(world_from_right.inverse() * pivot);
    ASSERT_TRUE(in_left && in_right);
    EXPECT_NEAR(in_left->x() + in_right->x(), p.width_px - 1, 1e-9);
    EXPECT_NEAR(in_left->y(), 0.5 * (p.height_px - 1), 1e-9);
    EXPECT_NEAR(in_left->x() - in_right->x(), c.rectified.disparity_px(p.distance_m), 1e-9);
    // The field of view spans the picture from edge to edge, half a pixel beyond the last centres.
    EXPECT_NEAR(2 * std::atan(0.5 * p.width_px / c.rectified.f_px), p.field_of_view_rad, 1e-12);
}

TEST(VirtualRigPlacementTest, HasADistinctIdPerPlacement) {
    VirtualRigPlacement p = small_placement();
    const std::string id = ideal_virtual_rig(p).id;
    EXPECT_EQ(ideal_virtual_rig(p).id, id);
    p.azimuth_rad += 1e-9;
    EXPECT_NE(ideal_virtual_rig(p).id, id);
}

TEST(VirtualRigPlacementTest, RefusesInvalidPlacements) {
    const auto refuses = [](auto change) {
        VirtualRigPlacement p = small_placement();
        change(p);
        EXPECT_THROW(ideal_virtual_rig(p), Error);
    };
    refuses([](auto& p) { p.width_px = 0; });
    refuses([](auto& p) { p.height_px = 5000; });
    refuses([](auto& p) { p.baseline_m = -0.1; });
    refuses([](auto& p) { p.field_of_view_rad = 3.2; });
    refuses([](auto& p) { p.elevation_rad = 1.6; });
    refuses([](auto& p) { p.distance_m = NAN; });
}

TEST_F(VirtualRigTest, ExactDisparityMapsTheLeftImageToTheRight) {
    VirtualStage stage(library_);
    const StereoCalibration c = ideal_virtual_rig(small_placement());
    const VirtualStereoFrame frame = render_virtual_rig(stage, c, 1200ms, 0, {});
    StageCamera right;
    right.width_px = c.right.width_px;
    right.height_px = c.right.height_px;
    right.K = c.right.K();
    right.world_from_camera = c.world_from_left * c.right_from_left.inverse();
    const DepthImage right_depth_m =
        stage.render(right, 1200ms, {.pictures = StagePictures::depth}).depth_m;
    int visible = 0, alike = 0;
    double difference = 0, unshifted = 0;
    for (int y = 0; y < frame.left.rows; ++y)
        for (int x = 0; x < frame.left.cols; ++x) {
            ASSERT_GT(frame.exact_disparity(y, x), 0);
            const double d =
                static_cast<double>(frame.exact_disparity(y, x)) / disparity_steps_per_px;
            const double at = x - d;
            const int u = static_cast<int>(std::floor(at));
            if (u < 0 || u + 1 >= frame.right.cols) continue;
            const double depth_m = c.rectified.depth_m(d);
            // Hidden in the right picture, or at an edge there.
            if (std::abs(right_depth_m(y, u) - depth_m) > 0.02 * depth_m ||
                std::abs(right_depth_m(y, u + 1) - depth_m) > 0.02 * depth_m)
                continue;
            double error = 0;
            for (int channel = 0; channel < 3; ++channel) {
                const double value = (1 - (at - u)) * frame.right(y, u)[channel] +
                                     (at - u) * frame.right(y, u + 1)[channel];
                error += std::abs(value - frame.left(y, x)[channel]) / 3;
                unshifted += std::abs(frame.right(y, x)[channel] - frame.left(y, x)[channel]) / 3.0;
            }
            ++visible;
            difference += error;
            alike += error < 20;
        }
    EXPECT_GT(visible, static_cast<int>(frame.left.total()) * 3 / 4);
    EXPECT_GT(alike, visible * 95 / 100);
    EXPECT_LT(difference / visible, 6.0);
    EXPECT_LT(difference, 0.35 * unshifted);
}

TEST(DisparityFromDepth, RoundsToStepsAndMarksTheUnknown) {
    RectifiedStereo geometry;
    geometry.f_px = 100;
    geometry.baseline_m = 0.1;
    geometry.cx_right_px = 2;  // doffs 2
    DepthImage depth_m(1, 4);
    depth_m << 1.0f, 0.0f, 6.0f, 0.0001f;
    const DisparityImage disparity = disparity_from_depth(depth_m, geometry);
    EXPECT_EQ(disparity(0, 0), (10 - 2) * disparity_steps_per_px);
    EXPECT_EQ(disparity(0, 1), 0) << "unknown stays unknown";
    EXPECT_EQ(disparity(0, 2), 0) << "beyond zero disparity";
    EXPECT_EQ(disparity(0, 3), 0) << "nearer than the wire can say";
}

/// A rig with real-life flaws: distortion of either lens, a turned right camera.
StereoCalibration flawed_rig(LensModel lens, const std::vector<double>& distortion) {
    VirtualRigPlacement placement = small_placement();
    placement.field_of_view_rad = 0.9;
    StereoCalibration c = ideal_virtual_rig(placement);
    c.left.lens = c.right.lens = lens;
    c.left.distortion = c.right.distortion = distortion;
    c.left.fy_px *= 1.02;
    c.left.skew_px = 0.8;
    c.right.cx_px += 3.25;
    c.right_from_left = Eigen::Translation3d(c.right_from_left.translation()) *
                        Eigen::AngleAxisd(0.03, Vector3d(0.4, 0.7, -0.5).normalized());
    c.rectified = {};
    compute_rectification(c, 0);
    return c;
}

class VirtualLensTest
    : public VirtualRigTest,
      public testing::WithParamInterface<std::tuple<LensModel, std::vector<double>>> {};

TEST_P(VirtualLensTest, RectifiedSensorImagesEqualIdealOnes) {
    const StereoCalibration c =
        flawed_rig(std::get<LensModel>(GetParam()), std::get<std::vector<double>>(GetParam()));
    VirtualStage stage(library_);
    const VirtualStereoFrame frame = render_virtual_rig(stage, c, 900ms, 0, {});
    ASSERT_EQ(frame.left.size(), cv::Size(c.left.width_px, c.left.height_px));
    for (const Side side : {Side::left, Side::right}) {
        const bool is_left = side == Side::left;
        StageCamera ideal;
        ideal.width_px = c.rectified.width_px;
        ideal.height_px = c.rectified.height_px;
        ideal.K = c.rectified.K_left();
        ideal.K(0, 2) = is_left ? c.rectified.cx_left_px : c.rectified.cx_right_px;
        ideal.world_from_camera = c.world_from_rectified_left();
        if (!is_left)
            ideal.world_from_camera =
                ideal.world_from_camera * Eigen::Translation3d(c.rectified.baseline_m, 0, 0);
        const StageRendering expected = stage.render(ideal, 900ms);
        ColourImage rectified;
        cv::remap(is_left ? frame.left : frame.right, rectified, make_rectification_map(c, side),
                  cv::noArray(), cv::INTER_CUBIC);
        const cv::Rect inner(4, 4, rectified.cols - 8, rectified.rows - 8);
        const double right_way = psnr_db(rectified(inner), expected.colour(inner));
        // One pixel off costs this much, so that the bound below means something.
        const double one_off = psnr_db(rectified(inner), expected.colour(inner + cv::Point(0, 1)));
        EXPECT_GT(right_way, 24.0) << (is_left ? "left" : "right");
        EXPECT_GT(right_way, one_off + 3.0) << (is_left ? "left" : "right");
        if (is_left) {
            EXPECT_EQ(cv::norm(frame.exact_disparity,
                               disparity_from_depth(expected.depth_m, c.rectified), cv::NORM_INF),
                      0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Lenses, VirtualLensTest,
    testing::Values(
        std::tuple(LensModel::pinhole, std::vector<double>{}),
        std::tuple(LensModel::pinhole, std::vector<double>{-0.28, 0.07, 0.001, -0.0008, 0.01}),
        std::tuple(LensModel::pinhole,
                   std::vector<double>{0.1, -0.05, 0.0005, 0.001, 0.01, 0.3, -0.02, 0.01}),
        std::tuple(LensModel::fisheye, std::vector<double>{0.05, -0.01, 0.004, -0.001})));

TEST(VirtualLens, RefusesALensBeyondAnyPinholeImage) {
    StereoCalibration c = ideal_virtual_rig(small_placement());
    c.left.lens = c.right.lens = LensModel::fisheye;
    c.left.fx_px = c.left.fy_px = c.right.fx_px = c.right.fy_px = 60;
    EXPECT_THROW(VirtualRig(c, {}), Error);
}

TEST(SensorNoiseTest, IsGaussianWithTheSigmaAskedFor) {
    for (const double sigma : {0.8, 4.0}) {
        ColourImage picture(240, 320, cv::Vec4b(128, 100, 150, 255));
        add_sensor_noise(picture, {sigma, 5}, 0, 17);
        double sum = 0, squares = 0, fourth = 0;
        for (const cv::Vec4b& c : picture) {
            const double e = c[0] - 128.0;
            sum += e;
            squares += e * e;
            fourth += e * e * e * e;
            ASSERT_EQ(c[3], 255);
        }
        const double n = static_cast<double>(picture.total());
        const double variance = squares / n;
        // Rounding to whole grey levels adds a variance of 1/12.
        EXPECT_NEAR(sum / n, 0, 5 * sigma / std::sqrt(n) + 0.005);
        EXPECT_NEAR(variance, sigma * sigma + 1.0 / 12, 0.03 * (sigma * sigma + 1.0 / 12));
        if (sigma > 2) {
            EXPECT_NEAR(fourth / n / (variance * variance), 3.0, 0.1);
        }
    }
}

TEST(SensorNoiseTest, RepeatsForTheSameFrameAndForNoOther) {
    const ColourImage clean(60, 80, cv::Vec4b(128, 128, 128, 255));
    const auto noisy = [&](std::uint64_t seed, int side, std::uint64_t frame) {
        ColourImage picture = clean.clone();
        add_sensor_noise(picture, {6, seed}, side, frame);
        return picture;
    };
    const ColourImage reference = noisy(1, 0, 7);
    EXPECT_EQ(cv::norm(reference, noisy(1, 0, 7), cv::NORM_INF), 0);
    const auto correlation = [&](const ColourImage& other) {
        double product = 0, square = 0;
        for (int y = 0; y < clean.rows; ++y)
            for (int x = 0; x < clean.cols; ++x)
                for (int channel = 0; channel < 3; ++channel) {
                    const double a = reference(y, x)[channel] - 128.0;
                    product += a * (other(y, x)[channel] - 128.0);
                    square += a * a;
                }
        return product / square;
    };
    EXPECT_LT(std::abs(correlation(noisy(2, 0, 7))), 0.05) << "another seed";
    EXPECT_LT(std::abs(correlation(noisy(1, 1, 7))), 0.05) << "the other side";
    EXPECT_LT(std::abs(correlation(noisy(1, 0, 8))), 0.05) << "the next frame";
    cv::Mat shifted;
    const cv::Mat m = (cv::Mat_<float>(2, 3) << 1, 0, 1, 0, 1, 0);
    cv::warpAffine(reference, shifted, m, reference.size(), cv::INTER_NEAREST, cv::BORDER_WRAP);
    EXPECT_LT(std::abs(correlation(shifted)), 0.05) << "the next pixel";
}

TEST(SensorNoiseTest, ChecksItsLimits) {
    ColourImage picture(20, 30, cv::Vec4b(2, 253, 128, 255));
    const ColourImage clean = picture.clone();
    add_sensor_noise(picture, {0, 1}, 0, 0);
    EXPECT_EQ(cv::norm(picture, clean, cv::NORM_INF), 0);
    EXPECT_THROW(add_sensor_noise(picture, {-1, 1}, 0, 0), Error);
    EXPECT_THROW(add_sensor_noise(picture, {NAN, 1}, 0, 0), Error);
    add_sensor_noise(picture, {20, 1}, 0, 0);
    std::vector<cv::Mat> channels;
    cv::split(picture, channels);
    EXPECT_GT(cv::countNonZero(channels[0] == 0), 200) << "clamped, not wrapped";
    EXPECT_GT(cv::countNonZero(channels[1] == 255), 200);
}

}  // namespace
}  // namespace vantage
