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

/// Says which pulse of the stage's clock a source delivers next, for sources that follow the clock
/// themselves. A source that is late gets the newest pulse; those it left out are counted.
class PulsePacer {
  public:
    explicit PulsePacer(const PulseGrid& grid) : grid_(grid) {}

    /// Waits until the next pulse and takes it; empty when the time is up before. Absolute
    /// deadlines on CLOCK_TAI.
    std::optional<Pulse> wait_next(std::chrono::nanoseconds timeout);

    /// The pulse to wait for at `now`: the one after the last taken, or the newest if more have
    /// passed. If the clock was set back by more than two periods, the pulses go back with it.
    Pulse due(TaiTime now) const;
    /// Counts what lies between the last one taken and this one as missed. If CLOCK_TAI was set
    /// meanwhile, the missed pulses are those that CLOCK_MONOTONIC has room for.
    void take(const Pulse& pulse);

    /// Pulses left out since the first one taken.
    std::uint64_t missed() const { return missed_; }
    /// How often the clock was set.
    std::uint64_t clock_steps() const { return clock_steps_; }

  private:
    PulseGrid grid_;
    std::optional<std::uint64_t> last_;
    MonotonicTime last_monotonic_{};
    std::uint64_t missed_ = 0;
    std::uint64_t clock_steps_ = 0;
};

}  // namespace vantage
