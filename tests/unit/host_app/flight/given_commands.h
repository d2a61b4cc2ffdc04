#pragma once

#include <algorithm>
#include <vector>

#include "host_app/flight/flight_input.h"

namespace vantage {

/// The number in the last command of a type, or 0 without one.
template <class T>
int number_of(const FlightInput& input) {
    const T* found = input.find<T>();
    return found ? found->number : 0;
}

/// Whether the input of a tick has a transport command.
template <class T>
bool has(const TransportInput& input) {
    return std::any_of(input.commands.begin(), input.commands.end(), [](const TimeCommand& each) {
        const auto* transport = std::get_if<TransportCommand>(&each);
        return transport && std::holds_alternative<T>(*transport);
    });
}

/// Sum of all frames to step, backwards and forwards.
inline double stepped_frames(const FlightInput& input) {
    double frames = 0;
    input.for_each<TransportCommand>([&](const auto& each) {
        if constexpr (std::is_same_v<decltype(each), const command::StepFrames&>)
            frames += each.frames;
    });
    return frames;
}

/// Sum of all changes of speed, in steps.
inline int speed_steps(const FlightInput& input) {
    int steps = 0;
    input.for_each<TransportCommand>([&](const auto& each) {
        if constexpr (std::is_same_v<decltype(each), const command::ChangeSpeed&>)
            steps += each.steps;
    });
    return steps;
}

inline std::vector<ReplayCall> replay_calls(const FlightInput& input) {
    std::vector<ReplayCall> calls;
    for (const Command& each : input.commands)
        if (const auto* call = std::get_if<ReplayCall>(&each)) calls.push_back(*call);
    return calls;
}

}  // namespace vantage
