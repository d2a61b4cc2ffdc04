#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "common/base/time/time.h"

namespace vantage {

/// The ticks of the output: tick n is due at start + n / rate. A caller that is late gets the
/// newest tick that is due, so the flight keeps real time however long a frame takes. Not
/// thread-safe.
class TickClock {
  public:
    /// Precondition: rate_hz > 0.
    TickClock(double rate_hz, MonotonicTime start) : rate_hz_(rate_hz), start_(start) {}

    /// Time from the start to a tick.
    std::chrono::nanoseconds time_of(std::uint64_t tick) const {
        return std::chrono::nanoseconds(std::llround(static_cast<double>(tick) / rate_hz_ * 1e9));
    }
    /// Time until next_tick() is due; 0 if it is.
    std::chrono::nanoseconds until_next(MonotonicTime now) const {
        return std::max(std::chrono::nanoseconds(0), start_ + time_of(next_) - now);
    }
    /// The newest tick that is due at `now`, but never one that was returned before.
    std::uint64_t next_tick(MonotonicTime now) {
        const double elapsed_s = std::chrono::duration<double>(now - start_).count();
        // The small addition keeps a tick that is just due from rounding down to the one before.
        const auto due = static_cast<std::uint64_t>(std::max(0.0, elapsed_s * rate_hz_ + 1e-6));
        const std::uint64_t tick = std::max(next_, due);
        next_ = tick + 1;
        return tick;
    }

  private:
    double rate_hz_;
    MonotonicTime start_;
    std::uint64_t next_ = 0;
};

}  // namespace vantage
