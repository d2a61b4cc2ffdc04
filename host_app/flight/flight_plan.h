#pragma once

#include <cstdint>
#include <optional>

#include "host_app/flight/flight_book.h"

namespace vantage {

/// Settings of flight by hand, from the stage file.
struct FlightHabits {
    bool holds_horizon = true;  ///< at the start
    double shot_s = 1.5;        ///< duration of a flight to a shot that was stored by hand
    double keyframe_gap_s = 3;  ///< between keyframes that are added one after the other
    double max_turn_rad_s = FlightLimits().max_turn_rad_s;
    double max_zoom_rad_s = FlightLimits().max_zoom_rad_s;
    std::optional<double> max_speed_m_s = {};  ///< empty: derived from the depth of the stage
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

/// Start, move and duration of a session's flight.
struct FlightPlan {
    std::optional<OrbitView> start;  ///< empty: derived from the rigs (see frame_stage())
    std::optional<Move> move;        ///< plays from the start until the operator takes over
    FlightHabits habits{};
    FlightBook book{};                    ///< shots, and the move if `move` is empty
    std::optional<std::uint64_t> frames;  ///< number of frames after which the session ends
    std::optional<double> seconds;        ///< time after which it ends

    bool is_over(std::uint64_t pictures, double time_s) const {
        return (frames && pictures >= *frames) || (seconds && time_s >= *seconds);
    }
};

}  // namespace vantage
