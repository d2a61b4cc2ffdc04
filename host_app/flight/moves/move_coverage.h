#pragma once

#include <vector>

#include "host_app/flight/corridor.h"
#include "host_app/flight/moves/move.h"

namespace vantage {

/// A part of a move that is beyond the end of the corridor.
struct UncoveredPart {
    double from_s = 0, to_s = 0;
    Coverage least;
};

/// In order of time; times are good to 0.1 s.
std::vector<UncoveredPart> uncovered_parts(const Move& move, const Corridor& corridor);

}  // namespace vantage
