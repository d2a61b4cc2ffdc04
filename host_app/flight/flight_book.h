#pragma once

#include <array>
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

}  // namespace vantage
