#pragma once

#include <cstdint>
#include <optional>

namespace vantage {

/// Counts the numbers that a driver's running count of pictures left out. The count wraps at 2^32
/// and begins anew when the stream does.
class SequenceGaps {
  public:
    void see(std::uint32_t sequence) {
        // A step of more than half the range is a driver that began again, not a loss.
        constexpr std::uint32_t half_range = 1u << 31;
        const std::uint32_t step = last_ ? sequence - *last_ : 1;
        if (step > 1 && step < half_range) lost_ += step - 1;
        last_ = sequence;
    }
    void restart() { last_.reset(); }
    std::uint64_t lost() const { return lost_; }

  private:
    std::optional<std::uint32_t> last_;
    std::uint64_t lost_ = 0;
};

}  // namespace vantage
