#pragma once

#include <cstdint>
#include <optional>

#include "host_app/flight/flight_book.h"
#include "host_app/flight/flight_habits.h"

namespace vantage {

/// What a session is asked to fly.
struct FlightPlan {
    /// Nothing: where the stage's rigs say.
    std::optional<OrbitView> start;
    std::optional<Move> move;  ///< in a window it plays until the operator takes over
    FlightHabits habits{};
    FlightBook book{};                    ///< shots, and a move for when there is none yet
    std::optional<std::uint64_t> frames;  ///< pictures after which the session ends by itself
    std::optional<double> seconds;        ///< time after which it does

    bool is_over(std::uint64_t pictures, double time_s) const {
        return (frames && pictures >= *frames) || (seconds && time_s >= *seconds);
    }
};

}  // namespace vantage
