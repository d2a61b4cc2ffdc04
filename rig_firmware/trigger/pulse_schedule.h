#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/time/pulse_grid.h"

namespace vantage {

/// Which pulse is next, and whether it may still be sent. A pulse that would be later than the
/// limit is skipped and counted, never sent off the grid. Clocks come in as arguments.
class PulseSchedule {
  public:
    PulseSchedule(const PulseGrid& grid, std::chrono::nanoseconds late_limit)
        : grid_(grid), late_limit_(late_limit) {}

    /// The pulse to wait for: the first that is still to come, though none before `first` and none
    /// twice. Pulses that passed since the last one are skipped. If the clock was set back by more
    /// than two periods, the pulses go back with it: `first`, which had begun, is waited for no
    /// more.
    std::uint64_t next(TaiTime now, std::uint64_t first);

    /// At the moment of sending it: its lateness, or empty where it is beyond the limit and the
    /// pulse is skipped.
    std::optional<std::chrono::nanoseconds> send(std::uint64_t index, TaiTime now);

    TaiTime time_of(std::uint64_t index) const { return grid_.time_of(index); }
    std::uint64_t sent() const { return sent_; }
    std::uint64_t skipped() const { return skipped_; }
    std::uint64_t clock_steps() const { return clock_steps_; }

  private:
    PulseGrid grid_;
    std::chrono::nanoseconds late_limit_;
    std::optional<std::uint64_t> last_;   ///< sent or skipped
    std::optional<std::uint64_t> begun_;  ///< a `first` of before the clock was set back
    std::uint64_t sent_ = 0, skipped_ = 0, clock_steps_ = 0;
};

}  // namespace vantage
