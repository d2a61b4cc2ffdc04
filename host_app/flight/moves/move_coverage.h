#pragma once

#include <vector>

#include "host_app/flight/corridor.h"
#include "host_app/flight/moves/move.h"

namespace vantage {

/// A part of a move outside the corridor.
struct UncoveredPart {
    double from_s = 0, to_s = 0;
    Coverage least;
};

/// All parts of a move outside the corridor, in order of time, with times to 0.1 s.
std::vector<UncoveredPart> uncovered_parts(const Move& move, const Corridor& corridor);

}  // namespace vantage
