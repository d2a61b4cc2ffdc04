#pragma once

#include <chrono>
#include <mutex>
#include <optional>

#include "common/base/time/time.h"
#include "host_app/flight/camera_state.h"

namespace vantage {

/// Where a tracked camera (a pan bar, a crane, a real camera) says that it is, on its way from
/// whoever hears it to the programme's thread. Only the newest counts.
class TrackedCamera {
  public:
    void put(const CameraState& camera, MonotonicTime now);
    /// Nothing: it has said nothing for a while.
    std::optional<CameraState> newest(MonotonicTime now) const;

    /// One that is silent for so long is not there.
    static constexpr std::chrono::milliseconds patience{500};

  private:
    mutable std::mutex mutex_;
    std::optional<CameraState> camera_;
    MonotonicTime heard_{};
};

/// Takes the camera from what flew it to what flies it now without a jump.
class CameraGlide {
  public:
    /// From now on another flies it.
    void begin();
    /// What is shown, dt_s after the last one, of what flies it.
    CameraState step(const CameraState& flown, double dt_s);
    bool is_over() const { return remaining_ <= 0; }

  private:
    std::optional<CameraState> shown_, from_;
    double remaining_ = 0;  ///< 1..0
};

}  // namespace vantage
