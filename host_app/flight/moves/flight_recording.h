#pragma once

#include <deque>
#include <optional>

#include "host_app/flight/moves/move.h"

namespace vantage {

/// The camera at one time of a recorded flight.
struct FlightSample {
    double time_s = 0;
    OrbitView view;
    std::optional<double> take_s = {};  ///< playback position in a take, from its start
};
using FlightRecording = std::deque<FlightSample>;

/// Allowed deviation of a move from the recorded flight.
struct FlightTolerance {
    double shift_m = 0.01;     ///< of the camera's place
    double turn_rad = 0.0017;  ///< of its direction and field of view: 0.1 degrees
    double take_s = 0.02;      ///< of the position in the take
};

struct SimplifiedFlight {
    Move move;
    double worst = 0;  ///< largest deviation, in units of the tolerance; may exceed 1
};

/// Simplifies a recorded flight to a move of few keyframes that stays within the tolerance at every
/// sample. If that would need more than most_keyframes, the tolerance is doubled until they
/// suffice. Times start at the first sample. Preconditions: at least one sample, times increase.
SimplifiedFlight simplified(const FlightRecording& flight, const FlightTolerance& tolerance,
                            const FlightLimits& limits, MovePath path);

}  // namespace vantage
