#pragma once

#include <deque>
#include <optional>

#include "host_app/flight/moves/move.h"

namespace vantage {

/// Where the camera was at one time.
struct FlightSample {
    double time_s = 0;
    OrbitView view;
    std::optional<double> take_s =
        {};  ///< where in a take the programme was, seconds from its start
};
using FlightRecording = std::deque<FlightSample>;

/// What a move may differ from the flight that it is made of.
struct FlightTolerance {
    double shift_m = 0.01;     ///< of the camera's place
    double turn_rad = 0.0017;  ///< of its turn and of its angle of view: 0.1 degrees
    double take_s = 0.02;      ///< of time in the take
};

struct SimplifiedFlight {
    Move move;
    double worst =
        0;  ///< of the tolerance that was asked for; over 1: too many keyframes otherwise
};

/// A move of few keyframes that is at every sample within the tolerance; where that would take more
/// than most_keyframes, within the least multiple of it that does not. Times begin at the first
/// sample. Preconditions: a sample or more, times growing.
SimplifiedFlight simplified(const FlightRecording& flight, const FlightTolerance& tolerance,
                            const FlightLimits& limits, MovePath path);

}  // namespace vantage
