#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/time/pulse_grid.h"

namespace vantage {

struct Pulse {
    std::uint64_t index = 0;
    TaiTime time{};
    MonotonicTime monotonic{};  ///< the same moment, for durations
};

/// Decides which pulse of the stage's clock a source delivers next, for sources that follow the
/// clock themselves. A late source gets the newest pulse, and the pulses it left out are counted.
/// Not thread-safe.
class PulsePacer {
  public:
    explicit PulsePacer(const PulseGrid& grid) : grid_(grid) {}

    /// Waits for the next pulse and takes it; empty after `timeout`. Uses absolute deadlines on
    /// CLOCK_TAI.
    std::optional<Pulse> wait_next(std::chrono::nanoseconds timeout);

    /// Pulse to wait for at `now`: the one after the last taken, or the newest if more have passed.
    /// If the clock was set back by more than two periods, the indices go back with it.
    Pulse due(TaiTime now) const;
    /// Counts the pulses between the last one taken and this one as missed. If CLOCK_TAI was set in
    /// between, CLOCK_MONOTONIC determines how many were missed.
    void take(const Pulse& pulse);

    /// Number of pulses left out since the first one taken.
    std::uint64_t missed() const { return missed_; }
    /// Number of times the clock was set.
    std::uint64_t clock_steps() const { return clock_steps_; }

  private:
    PulseGrid grid_;
    std::optional<std::uint64_t> last_;
    MonotonicTime last_monotonic_{};
    std::uint64_t missed_ = 0;
    std::uint64_t clock_steps_ = 0;
};

}  // namespace vantage
