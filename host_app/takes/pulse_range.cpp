#include "host_app/takes/pulse_range.h"

namespace vantage {

std::vector<PulseRange> missing_parts(PulseRange whole, std::span<const std::uint64_t> there) {
    std::vector<PulseRange> parts;
    std::uint64_t at = whole.from;
    for (const std::uint64_t pulse : there) {
        if (pulse < at) continue;
        if (pulse >= whole.to) break;
        if (pulse > at) parts.push_back({at, pulse});
        at = pulse + 1;
    }
    if (at < whole.to) parts.push_back({at, whole.to});
    return parts;
}

}  // namespace vantage
