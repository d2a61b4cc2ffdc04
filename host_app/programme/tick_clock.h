#pragma once

#include <chrono>
#include <cstdint>

#include "common/base/time/time.h"

namespace vantage {

/// The beat of the output: tick n is due at start + n / rate. Whoever is late for a tick gets the
/// newest one that is due, so that the flight keeps real time whatever a picture costs.
class TickClock {
  public:
    /// Precondition: rate_hz > 0.
    TickClock(double rate_hz, MonotonicTime start) : rate_hz_(rate_hz), start_(start) {}

    /// Time from the start to a tick.
    std::chrono::nanoseconds time_of(std::uint64_t tick) const;
    /// How long until next_tick() is due; 0 if it is.
    std::chrono::nanoseconds until_next(MonotonicTime now) const;
    /// The tick to show at `now`: the newest due one, but never one that was given before.
    std::uint64_t next_tick(MonotonicTime now);

  private:
    double rate_hz_;
    MonotonicTime start_;
    std::uint64_t next_ = 0;
};

}  // namespace vantage
