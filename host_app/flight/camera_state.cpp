#include "host_app/flight/camera_state.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace vantage {
namespace {

/// 0.1 pixel in a picture of 2000 columns and 45 degrees.
constexpr double same_angle_rad = 4e-5;

/// Time over which the velocity is measured.
constexpr double measured_s = 0.12;
constexpr double max_ahead_s = 1;
/// A camera that moves faster than this was cut.
constexpr double max_speed_m_s = 20, max_turn_rad_s = 2 * std::numbers::pi;

Eigen::AngleAxisd turn_of(const CameraState& from, const CameraState& to) {
    return Eigen::AngleAxisd(from.world_from_camera.linear().transpose() *
                             to.world_from_camera.linear());
}

Eigen::Vector3d shift_of(const CameraState& from, const CameraState& to) {
    return to.world_from_camera.translation() - from.world_from_camera.translation();
}

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
    return std::abs(turn_of(a, b).angle()) < same_angle_rad &&
           shift_of(a, b).norm() < same_angle_rad * a.focus_m &&
           std::abs(a.field_of_view_rad - b.field_of_view_rad) < same_angle_rad;
}

CameraState mixed(const CameraState& a, const CameraState& b, double share_of_b) {
    const auto mix = [&](double from, double to) { return from + share_of_b * (to - from); };
    return {interpolate(a.world_from_camera, b.world_from_camera, share_of_b),
            mix(a.field_of_view_rad, b.field_of_view_rad), mix(a.focus_m, b.focus_m)};
}

void CameraForecast::see(const CameraState& camera, double time_s) {
    if (!samples_.empty()) {
        const Sample& last = samples_.back();
        const double dt_s = time_s - last.time_s;
        if (shift_of(last.camera, camera).norm() > max_speed_m_s * dt_s ||
            turn_of(last.camera, camera).angle() > max_turn_rad_s * dt_s)
            samples_.clear();
    }
    samples_.push_back({camera, time_s});
    while (samples_.size() > 2 && samples_[1].time_s <= time_s - measured_s) samples_.pop_front();
}

CameraState CameraForecast::in(double ahead_s) const {
    const Sample &first = samples_.front(), &last = samples_.back();
    CameraState camera = last.camera;
    if (last.time_s <= first.time_s) return camera;
    const double share = std::min(ahead_s, max_ahead_s) / (last.time_s - first.time_s);
    const Eigen::AngleAxisd turn = turn_of(first.camera, last.camera);
    camera.world_from_camera.translation() += share * shift_of(first.camera, last.camera);
    camera.world_from_camera.linear() =
        last.camera.world_from_camera.linear() *
        Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
    return camera;
}

}  // namespace vantage
