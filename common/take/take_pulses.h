#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/take/take_reader.h"

namespace vantage {

struct PulseSpan {
    std::uint64_t first = 0, last = 0;
};
/// The pulses of all its rigs. Throws Error if the take has no frames.
PulseSpan pulse_span_of(const TakeReader& take);

/// The pulses with a frame of this rig, in order; none if the rig is not in the take.
std::vector<std::uint64_t> pulses_of_rig(const TakeReader& take, const std::string& rig);

}  // namespace vantage
