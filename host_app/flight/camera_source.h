#pragma once

#include <optional>

#include "common/base/time/time.h"
#include "host_app/flight/orbit_view.h"
#include "host_app/replay/transport_input.h"

namespace vantage {

/// What hands and plans want of one tick.
struct CameraStep {
    OrbitView view;
    /// Where what flies is no hand on an orbit: the camera, of which `view` is the nearest orbit.
    std::optional<CameraState> camera{};
    std::optional<OrbitView> preview{};  ///< of the camera on preview; nothing: there is none
    bool next_synthesiser = false, toggle_source_map = false;
    TransportInput time{};
    std::optional<MonotonicTime> hand{};  ///< of the earliest input that is new in this step
};

/// Whoever flies the virtual camera. Asked once a tick, on the programme's thread, as late as
/// possible; never waits.
class CameraSource {
  public:
    virtual ~CameraSource() = default;
    /// The camera at `time_s` after the start of the programme; times grow. `past_pulse`: where in
    /// the past, or in a take, the programme is.
    virtual CameraStep step(double time_s, std::optional<double> past_pulse) = 0;
    /// The camera of the step before, which flies to this shot from now on; one that takes no time
    /// is there at once.
    virtual CameraStep fly_to_shot(int number) = 0;
};

}  // namespace vantage
