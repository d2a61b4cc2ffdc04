#include "host_app/flight/moves/move_coverage.h"

#include <algorithm>
#include <cmath>

namespace vantage {

std::vector<UncoveredPart> uncovered_parts(const Move& move, const Corridor& corridor) {
    constexpr double step_s = 0.1;
    std::vector<UncoveredPart> parts;
    bool was_beyond = false;
    const int steps = static_cast<int>(std::ceil(move.duration_s() / step_s));
    for (int i = 0; i <= steps; ++i) {
        const double time_s = std::min(i * step_s, move.duration_s());

        const Coverage coverage = corridor.of(move.at(time_s).camera());
        const bool is_beyond = Corridor::place_of(coverage.share) == CorridorPlace::beyond;
        if (is_beyond && !was_beyond) parts.push_back({time_s, time_s, coverage});
        if (is_beyond) {
            parts.back().to_s = time_s;
            if (coverage.share < parts.back().least.share) parts.back().least = coverage;
        }
        was_beyond = is_beyond;
    }
    return parts;
}

}  // namespace vantage
