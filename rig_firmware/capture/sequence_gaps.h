#pragma once

#include <cstdint>
#include <optional>

namespace vantage {

/// Counts the gaps in a driver's running count of frames. The count wraps at 2^32 and restarts with
/// the stream.
class SequenceGaps {
  public:
    void see(std::uint32_t sequence) {
        // A step of more than half the range means that the driver restarted, not that frames were
        // lost.
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
