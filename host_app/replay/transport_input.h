#pragma once

#include <optional>

namespace vantage {

/// What hands do to time in one tick.
struct TransportInput {
    std::optional<double> to_pulse = {};  ///< there, and stand
    double pulses = 0;                    ///< jog, either way
    int speed_steps = 0;                  ///< to the next speeds of the shuttle, either way
    bool toggle_hold = false, to_live = false;
    bool mark_in = false, mark_out = false, clear_marks = false, toggle_loop = false;
    bool cue = false;  ///< to the in mark
    /// Of a take: where a flight says that time is. Nothing: time is its own.
    std::optional<double> at_pulse{};

    bool is_any() const {
        return to_pulse || pulses != 0 || speed_steps != 0 || toggle_hold || to_live || cue;
    }
};

}  // namespace vantage
