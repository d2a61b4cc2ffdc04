#include "rig_firmware/clock/clock_pair.h"

namespace vantage {

ClockPair ClockPair::now() {
    constexpr int tries = 3;
    ClockPair best;
    auto best_span = std::chrono::nanoseconds::max();
    for (int i = 0; i < tries; ++i) {
        const MonotonicTime before = MonotonicClock::now();
        const TaiTime tai = TaiClock::now();
        const std::chrono::nanoseconds span = MonotonicClock::now() - before;
        if (span >= best_span) continue;
        best_span = span;
        best = {tai, before + span / 2};
    }
    return best;
}

}  // namespace vantage
