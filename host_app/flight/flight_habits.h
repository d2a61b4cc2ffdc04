#pragma once

#include <optional>

#include "host_app/flight/orbit_view.h"

namespace vantage {

/// How hands fly on a stage, as its file says.
struct FlightHabits {
    bool holds_horizon = true;  ///< at first
    double shot_s = 1.5;        ///< of the flight to a shot that is stored by hand
    double keyframe_gap_s = 3;  ///< between keyframes that are put one after the other
    double max_turn_rad_s = FlightLimits().max_turn_rad_s;
    double max_zoom_rad_s = FlightLimits().max_zoom_rad_s;
    std::optional<double> max_speed_m_s = {};  ///< nothing: as the stage is deep
    double ramp_s = FlightLimits().ramp_s, follow_s = FlightLimits().follow_s;

    FlightLimits applied_to(FlightLimits limits) const {
        limits.max_turn_rad_s = max_turn_rad_s;
        limits.max_zoom_rad_s = max_zoom_rad_s;
        limits.max_speed_m_s = max_speed_m_s.value_or(limits.max_speed_m_s);
        limits.ramp_s = ramp_s;
        limits.follow_s = follow_s;
        return limits;
    }
};

}  // namespace vantage
