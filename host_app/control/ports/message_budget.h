#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/time/time.h"

namespace vantage {

/// Rate limit of messages (token bucket): a number per second, and a number at once after a rest.
/// Not thread-safe.
class MessageBudget {
  public:
    MessageBudget(double per_second, double at_once)
        : per_second_(per_second), at_once_(at_once), left_(at_once) {}

    /// Returns true if one more message is allowed now.
    bool take(MonotonicTime now) {
        if (last_ != MonotonicTime{})
            left_ = std::min(
                at_once_, left_ + per_second_ * std::chrono::duration<double>(now - last_).count());
        last_ = now;
        if (left_ < 1) return false;
        left_ -= 1;
        return true;
    }

  private:
    double per_second_, at_once_, left_;
    MonotonicTime last_{};
};

}  // namespace vantage
