#pragma once

#include <algorithm>
#include <cmath>

#include "rig_firmware/stereo/pi_model.h"

namespace vantage {

/// Longest time that one dispatch may hold the GPU of a Raspberry Pi 4, by PiModel: its kernel ends
/// jobs of more than 500 ms, and frames of the display wait for a job to end.
inline constexpr double max_dispatch_s = 0.03;
/// Lane instructions of such a dispatch.
inline constexpr double max_dispatch_operations = pi_models[0].operations_per_s * max_dispatch_s;

/// Calls run(first, count) for equal pieces of `lines` lines, as many as keep each below
/// `max_operations` of all `operations`. Pieces begin at multiples of `step`.
template <class Run>
void dispatch_in_parts(int lines, int step, double operations, double max_operations, Run run) {
    const double parts = std::max(std::ceil(operations / max_operations), 1.0);
    const int steps = static_cast<int>(std::ceil(lines / parts / step));
    for (int first = 0; first < lines; first += steps * step)
        run(first, std::min(steps * step, lines - first));
}

}  // namespace vantage
