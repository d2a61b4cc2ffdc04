#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "host_app/flight/moves/move.h"

namespace vantage {

/// A view that a key recalls.
struct Shot {
    std::string name;
    OrbitView view;
    double duration_s = 1.5;  ///< of the flight to it; 0: at once
    Easing easing = Easing::ease;
};

constexpr std::size_t most_shots = 9;
constexpr std::size_t most_keyframes = 1000;

/// What a flight file holds: shots by their numbers less 1, and a move.
struct FlightBook {
    std::optional<Move> move;
    std::array<std::optional<Shot>, most_shots> shots;
    double lowest_m = FlightLimits().min_eye_height_m;  ///< of cameras and pivots
};

/// Reads a flight file (hw_config/moves/demo.toml shows every key). Throws Error with file and line
/// for whatever does not fit.
FlightBook load_flight(const std::filesystem::path& path);

/// As a flight file: what load_flight() reads again, to nine digits.
std::string to_toml(const FlightBook& book);

}  // namespace vantage
