#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/time/pulse_grid.h"

namespace vantage {

/// Decides which pulse is next and whether it may still be sent. A pulse whose lateness exceeds the
/// limit is skipped and counted, never sent off the grid. Clocks are arguments. Not thread-safe.
class PulseSchedule {
  public:
    PulseSchedule(const PulseGrid& grid, std::chrono::nanoseconds late_limit)
        : grid_(grid), late_limit_(late_limit) {}

    /// Returns the pulse to wait for: the first one in the future, not before `first` and never the
    /// same one twice. Pulses that passed since the last one are skipped. If the clock was set back
    /// by more than two periods, the indices go back with it, and a `first` that had already begun
    /// no longer counts.
    std::uint64_t next(TaiTime now, std::uint64_t first);

    /// Call it when sending a pulse. Returns its lateness, or nothing if the lateness exceeds the
    /// limit and the pulse is skipped.
    std::optional<std::chrono::nanoseconds> send(std::uint64_t index, TaiTime now);

    TaiTime time_of(std::uint64_t index) const { return grid_.time_of(index); }
    std::uint64_t sent() const { return sent_; }
    std::uint64_t skipped() const { return skipped_; }
    std::uint64_t clock_steps() const { return clock_steps_; }

  private:
    PulseGrid grid_;
    std::chrono::nanoseconds late_limit_;
    std::optional<std::uint64_t> last_;   ///< sent or skipped
    std::optional<std::uint64_t> begun_;  ///< a `first` from before the clock was set back
    std::uint64_t sent_ = 0, skipped_ = 0, clock_steps_ = 0;
};

}  // namespace vantage
