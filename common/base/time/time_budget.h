#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/time/time.h"

namespace vantage {

/// A share of the time for work beside which other work has to go on. What is left of it and what
/// was taken too much count later, up to `longest_carried` of either.
class TimeBudget {
  public:
    /// `share` from 0 to 1. Of the time before `now` nothing is left.
    TimeBudget(double share, std::chrono::nanoseconds longest_carried, MonotonicTime now)
        : share_(share), longest_carried_(longest_carried), earned_(now) {}

    /// Whether some of it is left.
    bool has_some(MonotonicTime now) {
        const auto more = std::chrono::duration_cast<std::chrono::nanoseconds>(
            share_ * std::chrono::duration<double, std::nano>(now - earned_));
        earned_ = now;
        left_ = std::clamp(left_ + more, -longest_carried_, longest_carried_);
        return left_.count() > 0;
    }
    /// The work took so long.
    void spend(std::chrono::nanoseconds time) { left_ -= time; }

  private:
    double share_;
    std::chrono::nanoseconds longest_carried_, left_{0};
    MonotonicTime earned_;
};

}  // namespace vantage
