#pragma once

#include <string>
#include <vector>

#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// A Raspberry Pi's GPU in two numbers, for lower bounds of times: memory traffic as copies reach
/// it (measured elsewhere; a Pi 5 reaches 4 to 8 GB/s), and lane instructions that its QPUs issue
/// (4 lanes per cycle each). Caches and latency are not in it, and nothing here was run on a Pi.
struct PiModel {
    const char* name;
    double traffic_bytes_per_s;  ///< read + written
    double operations_per_s;     ///< instructions of one lane
};

inline constexpr PiModel pi_models[] = {
    {"Raspberry Pi 4", 2.5e9, 8 * 4 * 500e6},
    {"Raspberry Pi 5", 4.0e9, 12 * 4 * 960e6},
};

/// What the passes would take there: each the longer of its memory traffic and its arithmetic.
double modelled_frame_ms(const PiModel& model, const std::vector<PassReport>& passes);

/// A sentence a line for people, one for each of pi_models.
std::string pi_model_lines(const std::vector<PassReport>& passes);

}  // namespace vantage
