#pragma once

#include <string>
#include <vector>

#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// A Raspberry Pi's GPU in two numbers. A model: memory traffic was measured elsewhere as a copy's
/// rate, arithmetic is units x lanes x clock with half of the slots used; caches and latency are
/// not in it, and nothing here was run on a Pi.
struct PiModel {
    const char* name;
    double traffic_bytes_per_s;  ///< read + written
    double operations_per_s;
};

inline constexpr PiModel pi_models[] = {
    {"Raspberry Pi 4", 2 * 2.4e9, 0.5 * 8 * 4 * 500e6},
    {"Raspberry Pi 5", 2 * 4.1e9, 0.5 * 12 * 4 * 800e6},
};

/// What the passes would take there: each the longer of its memory traffic and its arithmetic.
double modelled_frame_ms(const PiModel& model, const std::vector<PassReport>& passes);

/// A sentence a line for people, one for each of pi_models.
std::string pi_model_lines(const std::vector<PassReport>& passes);

}  // namespace vantage
