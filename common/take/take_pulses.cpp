#include "common/take/take_pulses.h"

#include <algorithm>

#include "common/base/error.h"

namespace vantage {

PulseSpan pulse_span_of(const TakeReader& take) {
    PulseSpan span{~std::uint64_t{0}, 0};
    for (std::size_t rig = 0; rig < take.facts().rigs.size(); ++rig) {
        if (take.frames(rig).empty()) continue;
        span.first = std::min(span.first, take.frames(rig).front().pulse);
        span.last = std::max(span.last, take.frames(rig).back().pulse);
    }
    if (span.first > span.last) fail("{} holds no frame", take.path().string());
    return span;
}

std::vector<std::uint64_t> pulses_of_rig(const TakeReader& take, const std::string& rig) {
    std::vector<std::uint64_t> pulses;
    for (std::size_t i = 0; i < take.facts().rigs.size(); ++i)
        if (take.facts().rigs[i].name == rig)
            for (const TakeReader::Frame& frame : take.frames(i)) pulses.push_back(frame.pulse);
    return pulses;
}

}  // namespace vantage
