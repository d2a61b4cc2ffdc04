#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "host_app/flight/moves/move.h"

namespace vantage {

/// A stored camera view, which a command recalls.
struct Shot {
    std::string name;
    OrbitView view;
    double duration_s = 1.5;  ///< of the flight to it; 0: the camera cuts to it
    Easing easing = Easing::ease;
};

constexpr std::size_t most_shots = 9;
constexpr std::size_t most_keyframes = 1000;

/// Contents of a flight file: shots, by their numbers less 1, and a move.
struct FlightBook {
    std::optional<Move> move;
    std::array<std::optional<Shot>, most_shots> shots;
    double lowest_m = FlightLimits().min_eye_height_m;  ///< lower limit of cameras and pivots
};

/// Reads a flight file (hw_config/moves/demo.toml shows every key). Throws Error with file and line
/// if a value does not fit.
FlightBook load_flight(const std::filesystem::path& path);

/// The text of a flight file, which load_flight() reads back to nine digits.
std::string to_toml(const FlightBook& book);

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
