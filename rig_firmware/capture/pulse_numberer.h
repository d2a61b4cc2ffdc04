#pragma once

#include <cstdint>
#include <optional>

#include "common/base/time/pulse_grid.h"

namespace vantage {

/// Gives the frames of free-running sensors the index of the pulse nearest to their exposure. A
/// sensor in the middle between two pulses would jitter between them: the pulse after the last one
/// given is therefore accepted up to three quarters of a period away. Every pulse is given once.
/// Pulses between two frames count as missed, frames without a pulse of their own as surplus.
class PulseNumberer {
  public:
    explicit PulseNumberer(const PulseGrid& grid) : grid_(grid) {}

    /// Returns nothing for a surplus frame. Exposures ascend, unless the clock was set back: then
    /// the indices go back with it.
    std::optional<std::uint64_t> number(TaiTime exposure) {
        const std::uint64_t index = preferred(exposure);
        constexpr std::uint64_t most_surplus = 2;
        if (last_ && index <= *last_) {
            if (*last_ - index <= most_surplus) {
                ++surplus_;
                return std::nullopt;
            }
            ++clock_steps_;
        } else if (last_) {
            missed_ += index - *last_ - 1;
        }
        last_ = index;
        return index;
    }

    /// Resets the count, since pulses that the clock skipped or repeats were not missed.
    void clock_was_set() {
        if (last_) ++clock_steps_;
        last_.reset();
    }

    std::uint64_t missed() const { return missed_; }
    std::uint64_t surplus() const { return surplus_; }
    std::uint64_t clock_steps() const { return clock_steps_; }

  private:
    std::uint64_t preferred(TaiTime exposure) const {
        if (last_) {
            const auto away = exposure - grid_.time_of(*last_ + 1);
            const auto reach = grid_.period() * 3 / 4;
            if (away < reach && -away < reach) return *last_ + 1;
        }
        return grid_.nearest_index(exposure);
    }

    PulseGrid grid_;
    std::optional<std::uint64_t> last_;
    std::uint64_t missed_ = 0, surplus_ = 0, clock_steps_ = 0;
};

}  // namespace vantage
