#pragma once

#include <cstdint>
#include <optional>

#include "common/base/pulse_grid.h"

namespace vantage {

/// Gives pictures of sensors that run by themselves the index of the pulse nearest to their
/// exposure. Every pulse is given once; those between two pictures that none was nearest to are
/// counted as missed, pictures that a pulse has no room for as surplus.
class PulseNumberer {
  public:
    explicit PulseNumberer(const PulseGrid& grid) : grid_(grid) {}

    /// Empty for a surplus picture. Exposures come in rising order, unless the clock was set back:
    /// then the indices go back with it.
    std::optional<std::uint64_t> number(TaiTime exposure) {
        constexpr std::uint64_t most_jitter = 2;
        const std::uint64_t index = grid_.nearest_index(exposure);
        if (last_ && index <= *last_) {
            if (*last_ - index <= most_jitter) {
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

    std::uint64_t missed() const { return missed_; }
    std::uint64_t surplus() const { return surplus_; }
    std::uint64_t clock_steps() const { return clock_steps_; }

  private:
    PulseGrid grid_;
    std::optional<std::uint64_t> last_;
    std::uint64_t missed_ = 0, surplus_ = 0, clock_steps_ = 0;
};

}  // namespace vantage
