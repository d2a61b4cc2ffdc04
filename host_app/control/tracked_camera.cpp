#include "host_app/control/tracked_camera.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace vantage {
namespace {

constexpr double glide_s = 0.8;

CameraState mixed(const CameraState& a, const CameraState& b, double share_of_b) {
    const auto mix = [&](auto from, auto to) { return from + share_of_b * (to - from); };
    CameraState state;
    state.world_from_camera.translation() = mix(Eigen::Vector3d(a.world_from_camera.translation()),
                                                Eigen::Vector3d(b.world_from_camera.translation()));
    state.world_from_camera.linear() =
        Eigen::Quaterniond(a.world_from_camera.linear())
            .slerp(share_of_b, Eigen::Quaterniond(b.world_from_camera.linear()))
            .toRotationMatrix();
    state.field_of_view_rad = mix(a.field_of_view_rad, b.field_of_view_rad);
    state.focus_m = mix(a.focus_m, b.focus_m);
    return state;
}

}  // namespace

void TrackedCamera::put(const CameraState& camera, MonotonicTime now) {
    const std::lock_guard lock(mutex_);
    camera_ = camera;
    heard_ = now;
}

std::optional<CameraState> TrackedCamera::newest(MonotonicTime now) const {
    const std::lock_guard lock(mutex_);
    return camera_ && now - heard_ < patience ? camera_ : std::nullopt;
}

void CameraGlide::begin() {
    from_ = shown_;
    remaining_ = from_ ? 1 : 0;
}

CameraState CameraGlide::step(const CameraState& flown, double dt_s) {
    remaining_ = std::max(0.0, remaining_ - dt_s / glide_s);
    const double gone = 1 - remaining_;
    shown_ = remaining_ > 0 ? mixed(*from_, flown, gone * gone * (3 - 2 * gone)) : flown;
    return *shown_;
}

}  // namespace vantage
