#pragma once

#include <chrono>

#include "common/base/time/time.h"

namespace vantage {

/// CLOCK_TAI and CLOCK_MONOTONIC of this computer at one moment: carries sensor times, which the
/// kernel gives in CLOCK_MONOTONIC, to TAI. Both clocks are slewed alike, so that a pair of now
/// serves pictures of the last seconds; a step of CLOCK_TAI is followed from the next pair on.
struct ClockPair {
    TaiTime tai{};
    MonotonicTime monotonic{};

    /// Reads one clock between two readings of the other, the closest of a few tries.
    static ClockPair now();

    TaiTime to_tai(MonotonicTime time) const { return tai + (time - monotonic); }
};

}  // namespace vantage
