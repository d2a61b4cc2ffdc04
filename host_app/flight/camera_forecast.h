#pragma once

#include <deque>

#include "host_app/flight/camera_state.h"

namespace vantage {

/// Predicts a camera at constant velocity and constant turn rate, measured over the last 0.12 s. A
/// cut starts the measurement again.
class CameraForecast {
  public:
    /// Times must not decrease.
    void see(const CameraState& camera, double time_s);

    /// The camera `ahead_s` after the last one that was seen, with its lens; limited to 1 s, since
    /// no operator holds a course for longer. Precondition: see() was called.
    CameraState in(double ahead_s) const;

  private:
    struct Sample {
        CameraState camera;
        double time_s;
    };
    std::deque<Sample> samples_;
};

}  // namespace vantage
