#include "common/rectification/rectify_pass.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/rectification/packed_positions.h"
#include "common/rectification/rectify_reference.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

struct Lens {
    const char* name;
    LensModel model;
    std::vector<double> distortion;
};

void PrintTo(const Lens& lens, std::ostream* out) { *out << lens.name; }

/// A toed-in pair behind this lens, with everything off-centre, at an odd size.
StereoCalibration calibration_of(const Lens& lens, int width_px, int height_px, double alpha) {
    StereoCalibration calibration;
    calibration.id = "test";
    CameraModel camera;
    camera.width_px = width_px;
    camera.height_px = height_px;
    camera.fx_px = 0.9 * width_px;
    camera.fy_px = 0.93 * width_px;
    camera.cx_px = 0.48 * width_px;
    camera.cy_px = 0.53 * height_px;
    camera.lens = lens.model;
    camera.distortion = lens.distortion;
    calibration.left = camera;
    calibration.right = camera;
    calibration.right.fx_px *= 1.03;
    calibration.right_from_left.linear() =
        Eigen::AngleAxisd(0.04, Eigen::Vector3d(0.3, 1.0, 0.2).normalized()).toRotationMatrix();
    calibration.right_from_left.translation() = Eigen::Vector3d(-0.12, 0.003, 0.002);
    compute_rectification(calibration, alpha);
    return calibration;
}

/// A smooth pattern painted on the sphere of directions around a camera.
cv::Vec4b colour_towards(const Eigen::Vector3d& ray) {
    const Eigen::Vector3d d = ray.normalized();
    const auto wave = [](double phase) {
        return static_cast<unsigned char>(std::lround(127.5 + 120 * std::sin(phase)));
    };
    return {wave(9 * d.x() + 2 * d.y()), wave(8 * d.y() - 3 * d.x()), wave(5 * (d.x() + d.y())),
            255};
}

ColourImage photograph(const CameraModel& camera) {
    ColourImage picture(camera.height_px, camera.width_px);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x)
            picture(y, x) = colour_towards(camera.unproject({x, y}));
    return picture;
}

ColourImage random_picture(int width_px, int height_px) {
    ColourImage picture(height_px, width_px);
    cv::RNG random(11);
    random.fill(picture, cv::RNG::UNIFORM, 0, 256);
    for (cv::Vec4b& c : picture) c[3] = 255;
    return picture;
}

class RectifyPassTest : public testing::TestWithParam<Lens> {
  protected:
    ColourImage on_gpu(const StereoCalibration& calibration, Side side, const ColourImage& raw) {
        Texture texture(TextureFormat::rgba8, raw.cols, raw.rows);
        texture.upload(raw);
        RectifyPass pass(library_, calibration, side);
        return pass.rectify(texture).download();
    }
    EglContext context_;
    ShaderLibrary library_;
};

TEST_P(RectifyPassTest, EqualsItsReferenceOnNoiseForBothSides) {
    // alpha 1 keeps every source pixel, so that parts of the result see nothing.
    const StereoCalibration calibration = calibration_of(GetParam(), 61, 47, 1.0);
    const ColourImage raw = random_picture(61, 47);
    for (const Side side : {Side::left, Side::right}) {
        const ColourImage expected =
            rectify_reference(raw, make_rectification_map(calibration, side));
        EXPECT_EQ(cv::norm(on_gpu(calibration, side, raw), expected, cv::NORM_INF), 0);
    }
}

TEST_P(RectifyPassTest, EqualsItsReferenceWherePositionsAreTooFarToBePacked) {
    StereoCalibration calibration = calibration_of(GetParam(), 61, 47, 1.0);
    // The rectified picture is a part of a large one, far from the pixels that it shows.
    calibration.rectified.width_px = 300;
    calibration.rectified.cx_left_px += 200;
    const cv::Mat2f positions = make_rectification_map(calibration, Side::left);
    ASSERT_FALSE(packed_positions(positions, {61, 47}));
    const ColourImage raw = random_picture(61, 47);
    EXPECT_EQ(cv::norm(on_gpu(calibration, Side::left, raw), rectify_reference(raw, positions),
                       cv::NORM_INF),
              0);
}

TEST(PackedPositions, HoldsDistancesAndMarksWhatIsOutside) {
    cv::Mat2f positions(1, 4);
    positions(0, 0) = {0.5F, 1.25F};
    positions(0, 1) = {-1.0F, 0.0F};
    positions(0, 2) = {std::numeric_limits<float>::quiet_NaN(), 0.0F};
    positions(0, 3) = {2.0F, 3.0F};
    const auto words = packed_positions(positions, {10, 10});
    ASSERT_TRUE(words);
    const auto word = [](int x_256, int y_256) { return (32768 + x_256) | (32768 + y_256) << 16; };
    EXPECT_EQ((*words)(0, 0), word(128, 320));
    EXPECT_EQ((*words)(0, 1), 0);
    EXPECT_EQ((*words)(0, 2), 0);
    EXPECT_EQ((*words)(0, 3), word(-256, 768));
    positions(0, 3) = {131.0F, 3.0F};
    EXPECT_FALSE(packed_positions(positions, {200, 10})) << "128 px do not fit";
    EXPECT_TRUE(packed_positions(positions, {100, 10})) << "it is outside, however far";
}

TEST_P(RectifyPassTest, AgreesWithOpenCvOnASmoothPicture) {
    const StereoCalibration calibration = calibration_of(GetParam(), 311, 239, 0.5);
    const ColourImage raw = photograph(calibration.left);
    const ColourImage ours = on_gpu(calibration, Side::left, raw);
    ColourImage theirs;
    cv::remap(raw, theirs, make_rectification_map(calibration, Side::left), cv::noArray(),
              cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0, 0, 0, 255));
    // OpenCV rounds positions to 1/32 px; at the picture's rim, where colour falls to black within
    // a pixel, that is up to 8 grey levels.
    EXPECT_LE(cv::norm(ours, theirs, cv::NORM_INF), 9);
    EXPECT_LE(cv::norm(ours, theirs, cv::NORM_L1) / static_cast<double>(4 * ours.total()), 0.2);
}

TEST_P(RectifyPassTest, ShowsEveryDirectionWhereTheRectifiedCameraSeesIt) {
    const StereoCalibration calibration = calibration_of(GetParam(), 155, 119, 0.0);
    for (const Side side : {Side::left, Side::right}) {
        const bool is_left = side == Side::left;
        const ColourImage raw = photograph(is_left ? calibration.left : calibration.right);
        const ColourImage rectified = on_gpu(calibration, side, raw);
        const RectifiedStereo& r = calibration.rectified;
        const Eigen::Matrix3d camera_from_rectified =
            (is_left ? calibration.rectified_from_left : calibration.rectified_from_right)
                .transpose();
        const cv::Mat2f positions = make_rectification_map(calibration, side);
        int seen = 0;
        for (int y = 0; y < rectified.rows; ++y)
            for (int x = 0; x < rectified.cols; ++x) {
                const cv::Vec2f p = positions(y, x);
                if (p[0] < 0 || p[1] < 0 || p[0] > 154 || p[1] > 118) continue;
                ++seen;
                const double cx = is_left ? r.cx_left_px : r.cx_right_px;
                const Eigen::Vector3d ray((x - cx) / r.f_px, (y - r.cy_px) / r.f_px, 1.0);
                const cv::Vec4b expected = colour_towards(camera_from_rectified * ray);
                ASSERT_LE(cv::norm(rectified(y, x), expected, cv::NORM_INF), 2)
                    << "at " << x << "," << y;
            }
        EXPECT_GT(seen, 155 * 119 / 2);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Lenses, RectifyPassTest,
    testing::Values(
        Lens{"none", LensModel::pinhole, {}},
        Lens{"polynomial5", LensModel::pinhole, {-0.21, 0.08, 0.001, -0.002, 0.01}},
        Lens{"rational8", LensModel::pinhole, {0.4, -0.1, 0.001, -0.001, 0.01, 0.7, -0.05, 0.01}},
        Lens{"tilted14",
             LensModel::pinhole,
             {-0.15, 0.04, 0.001, 0.001, 0.01, 0.05, 0.01, 0.002, 0.002, -0.001, 0.001, 0.001, 0.02,
              -0.015}},
        Lens{"fisheye", LensModel::fisheye, {0.05, -0.01, 0.002, 0.001}}),
    [](const testing::TestParamInfo<Lens>& lens) { return lens.param.name; });

TEST(RectifyReference, IsOpaqueBlackOutsideAndWhereThePositionIsNoNumber) {
    const ColourImage raw(3, 3, cv::Vec4b(200, 100, 50, 255));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    cv::Mat2f positions(1, 6);
    positions(0, 0) = {1, 1};
    positions(0, 1) = {-1, 1};
    positions(0, 2) = {2.5f, 1};
    positions(0, 3) = {nan, 1};
    positions(0, 4) = {1, infinity};
    positions(0, 5) = {1, 3};
    const ColourImage rectified = rectify_reference(raw, positions);
    EXPECT_EQ(rectified(0, 0), cv::Vec4b(200, 100, 50, 255));
    EXPECT_EQ(rectified(0, 2), cv::Vec4b(100, 50, 25, 255));
    for (const int x : {1, 3, 4, 5}) EXPECT_EQ(rectified(0, x), cv::Vec4b(0, 0, 0, 255)) << x;
}

TEST(RectifyPassLimits, RefusesAPictureOfAnotherSizeAndNamesBoth) {
    const EglContext context;
    const ShaderLibrary library;
    RectifyPass pass(library, calibration_of({"none", LensModel::pinhole, {}}, 61, 47, 0),
                     Side::right);
    const Texture raw(TextureFormat::rgba8, 60, 47);
    const std::string sentence = thrown_sentence([&] { pass.rectify(raw); });
    EXPECT_NE(sentence.find("61x47"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("60x47"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("right"), std::string::npos) << sentence;
}

TEST(RectifyPassLimits, HandsARectifiedPictureThrough) {
    const EglContext context;
    const ShaderLibrary library;
    RectifiedStereo geometry;
    geometry.width_px = 61;
    geometry.height_px = 47;
    geometry.f_px = 50;
    geometry.cx_left_px = geometry.cx_right_px = 30;
    geometry.cy_px = 23;
    geometry.baseline_m = 0.1;
    RectifyPass pass(library, rectified_calibration(geometry), Side::left);
    const Texture raw(TextureFormat::rgba8, 61, 47);
    EXPECT_EQ(&pass.rectify(raw), &raw);
    EXPECT_EQ(pass.bytes_moved(), 0u);
}

}  // namespace
}  // namespace vantage
