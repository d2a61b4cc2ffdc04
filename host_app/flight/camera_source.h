#pragma once

#include <optional>

#include "common/base/time/time.h"
#include "host_app/flight/orbit_view.h"
#include "host_app/replay/transport_input.h"

namespace vantage {

/// Camera and operator input of one tick.
struct CameraStep {
    OrbitView view;
    /// The camera, where it is not on an orbit, as a tracked one; `view` is then the nearest orbit.
    std::optional<CameraState> camera{};
    std::optional<OrbitView> preview{};  ///< of the camera on preview; empty: there is none
    bool next_synthesiser = false, toggle_source_map = false;
    TransportInput time{};
    std::optional<MonotonicTime> input{};  ///< time of the earliest input that is new in this step
};

/// Source of the virtual camera. The programme calls it once a tick, on its own thread and as late
/// as possible. Calls never block.
class CameraSource {
  public:
    virtual ~CameraSource() = default;
    /// The camera `time_s` after the start of the programme; times never decrease. `past_pulse` is
    /// the playback position in the past or in a take; empty: live.
    virtual CameraStep step(double time_s, std::optional<double> past_pulse) = 0;
    /// Starts a flight to a shot and returns the camera of the step before; a shot without a flight
    /// time is reached at once.
    virtual CameraStep fly_to_shot(int number) = 0;
};

}  // namespace vantage
