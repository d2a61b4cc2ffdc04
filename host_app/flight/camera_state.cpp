#include "host_app/flight/camera_state.h"

#include <cmath>

#include <Eigen/Geometry>

namespace vantage {
namespace {

/// 0.1 pixel in a picture of 2000 columns and 45 degrees.
constexpr double same_angle_rad = 4e-5;

}  // namespace

Eigen::Matrix3d CameraState::K(int width_px, int height_px) const {
    const double f_px = 0.5 * width_px / std::tan(0.5 * field_of_view_rad);
    Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
    k(0, 0) = k(1, 1) = f_px;
    k(0, 2) = 0.5 * (width_px - 1);
    k(1, 2) = 0.5 * (height_px - 1);
    return k;
}

bool is_same_view(const CameraState& a, const CameraState& b) {
    const Eigen::AngleAxisd turn(a.world_from_camera.linear().transpose() *
                                 b.world_from_camera.linear());
    const double shift_m =
        (a.world_from_camera.translation() - b.world_from_camera.translation()).norm();
    return std::abs(turn.angle()) < same_angle_rad && shift_m < same_angle_rad * a.focus_m &&
           std::abs(a.field_of_view_rad - b.field_of_view_rad) < same_angle_rad;
}

CameraState mixed(const CameraState& a, const CameraState& b, double share_of_b) {
    const auto mix = [&](double from, double to) { return from + share_of_b * (to - from); };
    return {interpolate(a.world_from_camera, b.world_from_camera, share_of_b),
            mix(a.field_of_view_rad, b.field_of_view_rad), mix(a.focus_m, b.focus_m)};
}

}  // namespace vantage
