#include "host_app/control/tracked_camera.h"

#include <algorithm>

#include "host_app/flight/moves/move.h"

namespace vantage {
namespace {

constexpr double glide_s = 0.8;

}  // namespace

void TrackedCamera::put(const CameraState& camera, MonotonicTime now) {
    const std::lock_guard lock(mutex_);
    camera_ = camera;
    received_ = now;
}

std::optional<CameraState> TrackedCamera::newest(MonotonicTime now) const {
    const std::lock_guard lock(mutex_);
    return camera_ && now - received_ < timeout ? camera_ : std::nullopt;
}

void CameraGlide::begin() {
    from_ = shown_;
    remaining_ = from_ ? 1 : 0;
}

CameraState CameraGlide::step(const CameraState& flown, double dt_s) {
    remaining_ = std::max(0.0, remaining_ - dt_s / glide_s);
    const double gone = 1 - remaining_;
    shown_ = remaining_ > 0 ? mixed(*from_, flown, eased(gone)) : flown;
    return *shown_;
}

}  // namespace vantage
