#pragma once

#include <deque>

#include "host_app/flight/camera_state.h"

namespace vantage {

/// Where a camera will be if it goes on as it went in the last moments: straight on, turning as
/// fast. A cut begins anew.
class CameraForecast {
  public:
    /// Times never fall.
    void see(const CameraState& camera, double time_s);

    /// Of the camera that was seen last, whose lens it keeps; a second ahead at most, for nobody
    /// goes straight on for longer. Precondition: see() was called.
    CameraState in(double ahead_s) const;

  private:
    struct Seen {
        CameraState camera;
        double time_s;
    };
    std::deque<Seen> seen_;
};

}  // namespace vantage
