#pragma once

#include <optional>
#include <vector>

#include "host_app/replay/replay_call.h"

namespace vantage {

/// What hands do to time in one tick.
struct TransportInput {
    std::optional<double> to_pulse = {};  ///< there, and stand
    double pulses = 0;                    ///< jog, either way
    double shuttle_pulses = 0;            ///< what a spring-loaded ring asks for
    int speed_steps = 0;                  ///< to the next speeds of the shuttle, either way
    bool toggle_hold = false, to_live = false;
    bool mark_in = false, mark_out = false, clear_marks = false, toggle_loop = false;
    bool cue = false;  ///< to the in mark
    /// Of a take: where a flight says that time is. Nothing: time is its own.
    std::optional<double> at_pulse{};
    /// In their order, after all of the above.
    std::vector<ReplayCall> calls = {};

    bool is_any() const {
        return to_pulse || pulses != 0 || shuttle_pulses != 0 || speed_steps != 0 || toggle_hold ||
               to_live || cue || !calls.empty();
    }
};

}  // namespace vantage
