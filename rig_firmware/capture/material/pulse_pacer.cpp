#include "rig_firmware/capture/material/pulse_pacer.h"

#include <algorithm>

#include "common/base/time/clock_step_watch.h"

namespace vantage {

Pulse PulsePacer::due(TaiTime now) const {
    const std::uint64_t newest = grid_.index_at_or_before(now);
    std::uint64_t index = newest + 1;
    if (last_) {
        index = std::max(*last_ + 1, newest);
        const bool clock_went_back = grid_.time_of(index) > now + 2 * grid_.period();
        if (clock_went_back) index = newest + 1;
    }
    return {index, grid_.time_of(index), {}};
}

void PulsePacer::take(const Pulse& pulse) {
    const bool has_monotonic = last_monotonic_ != MonotonicTime{};
    const auto passed = pulse.monotonic - last_monotonic_;
    if (last_ && pulse.index > *last_) {
        const std::uint64_t left_out = pulse.index - *last_ - 1;
        const std::uint64_t had_time = has_monotonic && passed > grid_.period()
                                           ? static_cast<std::uint64_t>(passed / grid_.period()) - 1
                                           : 0;
        const auto allowed =
            static_cast<std::uint64_t>(ClockStepWatch::least_step / grid_.period());
        const bool clock_was_set = has_monotonic && left_out > had_time + allowed + 1;
        clock_steps_ += clock_was_set;
        missed_ += clock_was_set ? had_time : left_out;
    }
    if (last_ && pulse.index <= *last_) ++clock_steps_;
    last_ = pulse.index;
    last_monotonic_ = pulse.monotonic;
}

std::optional<Pulse> PulsePacer::wait_next(std::chrono::nanoseconds timeout) {
    const TaiTime now = TaiClock::now();
    const MonotonicTime monotonic_now = MonotonicClock::now();
    Pulse pulse = due(now);
    if (pulse.time > now + timeout) {
        sleep_until(now + timeout);
        return std::nullopt;
    }
    sleep_until(pulse.time);
    // The clock was set back while this thread slept.
    if (TaiClock::now() < pulse.time) return std::nullopt;
    pulse.monotonic = monotonic_now + (pulse.time - now);
    take(pulse);
    return pulse;
}

}  // namespace vantage
