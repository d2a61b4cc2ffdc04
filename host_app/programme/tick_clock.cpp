#include "host_app/programme/tick_clock.h"

#include <algorithm>
#include <cmath>

namespace vantage {

std::chrono::nanoseconds TickClock::time_of(std::uint64_t tick) const {
    return std::chrono::nanoseconds(std::llround(static_cast<double>(tick) / rate_hz_ * 1e9));
}

std::chrono::nanoseconds TickClock::until_next(MonotonicTime now) const {
    return std::max(std::chrono::nanoseconds(0), start_ + time_of(next_) - now);
}

std::uint64_t TickClock::next_tick(MonotonicTime now) {
    const double elapsed_s = std::chrono::duration<double>(now - start_).count();
    // The small addition keeps a tick that is just due from rounding down to the one before.
    const auto due = static_cast<std::uint64_t>(std::max(0.0, elapsed_s * rate_hz_ + 1e-6));
    const std::uint64_t tick = std::max(next_, due);
    next_ = tick + 1;
    return tick;
}

}  // namespace vantage
