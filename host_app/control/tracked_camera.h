#pragma once

#include <chrono>
#include <mutex>
#include <optional>

#include "common/base/time/time.h"
#include "host_app/flight/camera_state.h"

namespace vantage {

/// The newest pose of a tracked camera (a pan bar, a crane, a real camera), handed from the thread
/// that receives it to the programme's thread. Thread-safe.
class TrackedCamera {
  public:
    void put(const CameraState& camera, MonotonicTime now);
    /// Empty if no pose arrived within `timeout`.
    std::optional<CameraState> newest(MonotonicTime now) const;

    static constexpr std::chrono::milliseconds timeout{500};

  private:
    mutable std::mutex mutex_;
    std::optional<CameraState> camera_;
    MonotonicTime received_{};
};

/// Blends from one camera source to the next, so that the view does not jump when the source
/// changes. Not thread-safe.
class CameraGlide {
  public:
    /// Starts a blend from the camera of the last step.
    void begin();
    /// The blended camera, dt_s after the last step; `flown` is the camera of the new source.
    CameraState step(const CameraState& flown, double dt_s);
    bool is_over() const { return remaining_ <= 0; }

  private:
    std::optional<CameraState> shown_, from_;
    double remaining_ = 0;  ///< 1..0
};

}  // namespace vantage
