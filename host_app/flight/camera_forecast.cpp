#include "host_app/flight/camera_forecast.h"

#include <algorithm>
#include <numbers>

namespace vantage {
namespace {

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
