#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/time/time.h"

namespace vantage {

/// Limits background work to a share of the elapsed time. Unused and overdrawn time carry over, up
/// to `longest_carried` either way.
class TimeBudget {
  public:
    /// `share` is from 0 to 1. The budget starts empty at `now`.
    TimeBudget(double share, std::chrono::nanoseconds longest_carried, MonotonicTime now)
        : share_(share), longest_carried_(longest_carried), earned_(now) {}

    /// Whether budget is left.
    bool has_some(MonotonicTime now) {
        const auto more = std::chrono::duration_cast<std::chrono::nanoseconds>(
            share_ * std::chrono::duration<double, std::nano>(now - earned_));
        earned_ = now;
        left_ = std::clamp(left_ + more, -longest_carried_, longest_carried_);
        return left_.count() > 0;
    }
    /// The share from the last has_some() on.
    void set_share(double share) { share_ = share; }
    /// Charges the duration of work that was done.
    void spend(std::chrono::nanoseconds time) { left_ -= time; }

  private:
    double share_;
    std::chrono::nanoseconds longest_carried_, left_{0};
    MonotonicTime earned_;
};

}  // namespace vantage
