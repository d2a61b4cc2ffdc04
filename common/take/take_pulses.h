#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/take/take_reader.h"

namespace vantage {

struct PulseSpan {
    std::uint64_t first = 0, last = 0;
};
/// Of all its rigs. Throws Error if it holds no frame.
PulseSpan pulse_span_of(const TakeReader& take);

/// Of which it has a frame of this rig, in their order; none if the rig is not in it.
std::vector<std::uint64_t> pulses_of_rig(const TakeReader& take, const std::string& rig);

}  // namespace vantage
