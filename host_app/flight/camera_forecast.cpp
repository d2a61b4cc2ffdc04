#include "host_app/flight/camera_forecast.h"

#include <algorithm>
#include <numbers>

namespace vantage {
namespace {

/// That a speed is judged by.
constexpr double judged_s = 0.12;
constexpr double farthest_s = 1;
/// What goes faster was cut.
constexpr double most_m_s = 20, most_rad_s = 2 * std::numbers::pi;

Eigen::AngleAxisd turn_of(const CameraState& from, const CameraState& to) {
    return Eigen::AngleAxisd(from.world_from_camera.linear().transpose() *
                             to.world_from_camera.linear());
}

Eigen::Vector3d shift_of(const CameraState& from, const CameraState& to) {
    return to.world_from_camera.translation() - from.world_from_camera.translation();
}

}  // namespace

void CameraForecast::see(const CameraState& camera, double time_s) {
    if (!seen_.empty()) {
        const Seen& last = seen_.back();
        const double dt_s = time_s - last.time_s;
        if (shift_of(last.camera, camera).norm() > most_m_s * dt_s ||
            turn_of(last.camera, camera).angle() > most_rad_s * dt_s)
            seen_.clear();
    }
    seen_.push_back({camera, time_s});
    while (seen_.size() > 2 && seen_[1].time_s <= time_s - judged_s) seen_.pop_front();
}

CameraState CameraForecast::in(double ahead_s) const {
    const Seen &first = seen_.front(), &last = seen_.back();
    CameraState camera = last.camera;
    if (last.time_s <= first.time_s) return camera;
    const double share = std::min(ahead_s, farthest_s) / (last.time_s - first.time_s);
    const Eigen::AngleAxisd turn = turn_of(first.camera, last.camera);
    camera.world_from_camera.translation() += share * shift_of(first.camera, last.camera);
    camera.world_from_camera.linear() =
        last.camera.world_from_camera.linear() *
        Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
    return camera;
}

}  // namespace vantage
