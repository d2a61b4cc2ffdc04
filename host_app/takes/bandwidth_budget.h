#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/time/time.h"

namespace vantage {

/// What may be asked for now so that no more than so many bytes a second come: a bucket that fills
/// with time and holds a quarter of a second's worth. Clocks come in as arguments.
class BandwidthBudget {
  public:
    explicit BandwidthBudget(double bytes_s) : bytes_s_(bytes_s) {}

    bool may_spend(MonotonicTime now) {
        fill(now);
        return bytes_ >= 0;
    }
    /// It is known only when it comes how much it is: what is spent beyond is waited for. Below 0:
    /// that was expected and did not come.
    void spend(double bytes) { bytes_ -= bytes; }
    /// Until something may be spent.
    std::chrono::nanoseconds wait(MonotonicTime now) {
        fill(now);
        return std::chrono::nanoseconds(
            static_cast<std::int64_t>(std::max(0.0, -bytes_) / bytes_s_ * ns_per_s));
    }

  private:
    static constexpr double ns_per_s = 1e9, most_s = 0.25;
    void fill(MonotonicTime now) {
        if (filled_ != MonotonicTime{})
            bytes_ =
                std::min(most_s * bytes_s_,
                         bytes_ + bytes_s_ * std::chrono::duration<double>(now - filled_).count());
        filled_ = now;
    }

    double bytes_s_, bytes_ = 0;
    MonotonicTime filled_{};
};

}  // namespace vantage
