#include "rig_firmware/capture/material/pulse_pacer.h"

#include <algorithm>

namespace vantage {

Pulse PulsePacer::due(TaiTime now) const {
    const std::uint64_t newest = grid_.index_at_or_before(now);
    std::uint64_t index = newest + 1;
    if (last_) {
        index = std::max(*last_ + 1, newest);
        const bool clock_went_back = grid_.time_of(index) > now + 2 * grid_.period();
        if (clock_went_back) index = newest + 1;
    }
    return {index, grid_.time_of(index)};
}

void PulsePacer::take(const Pulse& pulse) {
    if (last_ && pulse.index > *last_) missed_ += pulse.index - *last_ - 1;
    if (last_ && pulse.index <= *last_) ++clock_steps_;
    last_ = pulse.index;
}

std::optional<Pulse> PulsePacer::wait_next(std::chrono::nanoseconds timeout) {
    const TaiTime now = TaiClock::now();
    const Pulse pulse = due(now);
    if (pulse.time > now + timeout) {
        sleep_until(now + timeout);
        return std::nullopt;
    }
    sleep_until(pulse.time);
    take(pulse);
    return pulse;
}

}  // namespace vantage
