#include "common/virtual_stage/virtual_rig.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/gl/context/limits.h"

namespace vantage {
namespace {

constexpr int points_per_side = 2;     ///< sample points per pixel side, seen through a lens
constexpr double widest_slope = 3.75;  ///< tan of 75 degrees

const Eigen::Vector3d pivot_m(0, 1, 0);

void require(double value, double low, double high, const char* what) {
    if (!(value >= low && value <= high))
        fail("the virtual rig's {} is {}; it must be {} to {}", what, value, low, high);
}

/// The id of a placement (FNV-1a over its numbers).
std::string placement_id(const VirtualRigPlacement& p) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&](std::uint64_t word) {
        for (int byte = 0; byte < 8; ++byte) {
            hash = (hash ^ (word & 0xff)) * 0x100000001b3u;
            word >>= 8;
        }
    };
    for (const double value :
         {p.azimuth_rad, p.elevation_rad, p.distance_m, p.baseline_m, p.field_of_view_rad,
          static_cast<double>(p.width_px), static_cast<double>(p.height_px)})
        add(std::bit_cast<std::uint64_t>(value));
    return fmt::format("{:016x}", hash);
}

/// The slopes (x/z, y/z) of the rays through points_per_side^2 points of every pixel.
cv::Mat2f ray_slopes(const CameraModel& model) {
    const int width = model.width_px * points_per_side, height = model.height_px * points_per_side;
    cv::Mat2f slopes(height, width);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Eigen::Vector2d pixel((x + 0.5) / points_per_side - 0.5,
                                        (y + 0.5) / points_per_side - 0.5);
            const Eigen::Vector3d ray = model.unproject(pixel);
            slopes(y, x) = {static_cast<float>(ray.x()), static_cast<float>(ray.y())};
        }
    return slopes;
}

}  // namespace

StereoCalibration ideal_virtual_rig(const VirtualRigPlacement& p) {
    constexpr double pi = std::numbers::pi;
    require(p.width_px, 1, PiLimits::max_image_side_px, "width in pixels");
    require(p.height_px, 1, PiLimits::max_image_side_px, "height in pixels");
    require(p.field_of_view_rad, 0.02, 0.8 * pi, "field of view in radians");
    require(p.distance_m, 0.2, 30, "distance in metres");
    require(p.baseline_m, 0.001, 5, "baseline in metres");
    require(p.elevation_rad, -0.49 * pi, 0.49 * pi, "elevation in radians");
    require(p.azimuth_rad, -100, 100, "azimuth in radians");
    RectifiedStereo geometry;
    geometry.width_px = p.width_px;
    geometry.height_px = p.height_px;
    geometry.f_px = 0.5 * p.width_px / std::tan(0.5 * p.field_of_view_rad);
    geometry.cx_left_px = geometry.cx_right_px = 0.5 * (p.width_px - 1);
    geometry.cy_px = 0.5 * (p.height_px - 1);
    geometry.baseline_m = p.baseline_m;
    StereoCalibration calibration = rectified_calibration(geometry);
    const double level = std::cos(p.elevation_rad);
    const Eigen::Vector3d middle =
        pivot_m + p.distance_m * Eigen::Vector3d(level * std::sin(p.azimuth_rad),
                                                 std::sin(p.elevation_rad),
                                                 level * std::cos(p.azimuth_rad));
    calibration.world_from_left = look_at(middle, pivot_m);
    calibration.world_from_left.translation() -=
        0.5 * p.baseline_m * calibration.world_from_left.linear().col(0);
    calibration.id = placement_id(p);
    return calibration;
}

VirtualRig::Sensor VirtualRig::make_sensor(const CameraModel& model,
                                           const Pose& world_from_camera) {
    Sensor sensor;
    sensor.size = {model.width_px, model.height_px};
    sensor.camera.world_from_camera = world_from_camera;
    const bool has_distortion = model.lens == LensModel::fisheye ||
                                std::any_of(model.distortion.begin(), model.distortion.end(),
                                            [](double k) { return k != 0; });
    if (!has_distortion) {
        sensor.camera.width_px = model.width_px;
        sensor.camera.height_px = model.height_px;
        sensor.camera.K = model.K();
        return sensor;
    }
    sensor.positions = ray_slopes(model);
    cv::Mat channels[2];
    cv::split(sensor.positions, channels);
    double low[2], high[2];
    for (int axis = 0; axis < 2; ++axis) {
        if (!cv::checkRange(channels[axis], true, nullptr, -widest_slope, widest_slope))
            fail(
                "the lens sees further than 75 degrees off its axis, or its distortion folds the "
                "image: the virtual stage cannot be filmed through it");
        cv::minMaxLoc(channels[axis], &low[axis], &high[axis]);
    }
    // As fine as the sample points, up to the GPU's limit; a margin of two pixels for filtering.
    constexpr double margin_px = 2;
    const double focal[2] = {points_per_side * model.fx_px, points_per_side * model.fy_px};
    double wide_focal[2];
    int wide_size[2];
    for (int axis = 0; axis < 2; ++axis) {
        const double span = std::max(high[axis] - low[axis], 1e-6);
        wide_focal[axis] =
            std::min(focal[axis], (PiLimits::max_image_side_px - 2 * margin_px - 2) / span);
        wide_size[axis] = static_cast<int>(std::ceil(wide_focal[axis] * span + 2 * margin_px)) + 1;
    }
    sensor.camera.width_px = wide_size[0];
    sensor.camera.height_px = wide_size[1];
    sensor.camera.K << wide_focal[0], 0, margin_px - wide_focal[0] * low[0], 0, wide_focal[1],
        margin_px - wide_focal[1] * low[1], 0, 0, 1;
    for (auto& p : sensor.positions)
        for (int axis = 0; axis < 2; ++axis)
            p[axis] = static_cast<float>(sensor.camera.K(axis, axis) * p[axis] +
                                         sensor.camera.K(axis, 2));
    return sensor;
}

VirtualRig::VirtualRig(const StereoCalibration& calibration, const SensorNoise& noise,
                       bool with_exact_disparity)
    : rectified_(calibration.rectified),
      noise_(noise),
      with_exact_disparity_(with_exact_disparity) {
    calibration.validate();
    left_ = make_sensor(calibration.left, calibration.world_from_left);
    right_ = make_sensor(calibration.right,
                         calibration.world_from_left * calibration.right_from_left.inverse());
    rectified_left_.width_px = rectified_.width_px;
    rectified_left_.height_px = rectified_.height_px;
    rectified_left_.K = rectified_.K_left();
    rectified_left_.world_from_camera = calibration.world_from_rectified_left();
}

ColourImage VirtualRig::see(const Sensor& sensor, VirtualStage& stage,
                            std::chrono::nanoseconds stage_time) {
    const bool has_lens = !sensor.positions.empty();
    // Through a lens, the sample points of a pixel replace the point spread of pinhole images:
    // averaging them blurs by the standard deviation of points_per_side uniform steps.
    ColourImage pinhole = stage
                              .render(sensor.camera, stage_time,
                                      {.pictures = StagePictures::colour,
                                       .anti_aliased = !has_lens,
                                       .stands_still = true})
                              .colour;
    if (!has_lens) return pinhole;
    ColourImage points, picture;
    cv::remap(pinhole, points, sensor.positions, cv::noArray(), cv::INTER_LINEAR);
    constexpr double averaged = (points_per_side * points_per_side - 1) / 12.0;
    constexpr double spread = points_per_side * point_spread_px;
    cv::GaussianBlur(points, points, {}, std::sqrt(spread * spread - averaged));
    cv::resize(points, picture, sensor.size, 0, 0, cv::INTER_AREA);
    return picture;
}

VirtualStereoFrame VirtualRig::render(VirtualStage& stage, std::chrono::nanoseconds stage_time,
                                      std::uint64_t frame_index) const {
    VirtualStereoFrame frame = render_noiseless(stage, stage_time);
    add_noise(frame, frame_index);
    return frame;
}

VirtualStereoFrame VirtualRig::render_noiseless(VirtualStage& stage,
                                                std::chrono::nanoseconds stage_time,
                                                std::chrono::nanoseconds right_later) const {
    VirtualStereoFrame frame;
    frame.left = see(left_, stage, stage_time);
    frame.right = see(right_, stage, stage_time + right_later);
    if (with_exact_disparity_) {
        const StageRendering exact = stage.render(
            rectified_left_, stage_time, {.pictures = StagePictures::depth, .stands_still = true});
        frame.exact_disparity = disparity_from_depth(exact.depth_m, rectified_);
    }
    return frame;
}

void VirtualRig::add_noise(VirtualStereoFrame& frame, std::uint64_t frame_index) const {
    add_sensor_noise(frame.left, noise_, 0, frame_index);
    add_sensor_noise(frame.right, noise_, 1, frame_index);
}

VirtualStereoFrame render_virtual_rig(VirtualStage& stage, const StereoCalibration& calibration,
                                      std::chrono::nanoseconds stage_time,
                                      std::uint64_t frame_index, const SensorNoise& noise) {
    return VirtualRig(calibration, noise).render(stage, stage_time, frame_index);
}

DisparityImage disparity_from_depth(const DepthImage& depth_m, const RectifiedStereo& geometry) {
    DisparityImage disparity(depth_m.size());
    const auto scale =
        static_cast<float>(geometry.f_px * geometry.baseline_m * disparity_steps_per_px);
    const auto offset = static_cast<float>(geometry.doffs_px() * disparity_steps_per_px);
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x) {
            const float z = depth_m(y, x);
            const float steps = z > 0 ? scale / z - offset : 0;
            disparity(y, x) = steps >= 0.5f && steps <= 65535.0f
                                  ? static_cast<unsigned short>(cvRound(steps))
                                  : static_cast<unsigned short>(0);
        }
    return disparity;
}

}  // namespace vantage
