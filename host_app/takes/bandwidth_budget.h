#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/time/time.h"

namespace vantage {

/// Limits the rate of requested bytes: a token bucket that holds a quarter of a second's worth.
/// Clock readings are arguments. Not thread-safe.
class BandwidthBudget {
  public:
    explicit BandwidthBudget(double bytes_s) : bytes_s_(bytes_s) {}

    bool may_spend(MonotonicTime now) {
        fill(now);
        return bytes_ >= 0;
    }
    /// Takes bytes out of the bucket, which may become negative, since sizes are known on arrival
    /// only. Negative: returns an estimate that did not arrive.
    void spend(double bytes) { bytes_ -= bytes; }
    /// The time until the bucket is not empty.
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
