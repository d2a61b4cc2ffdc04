#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "common/base/time/time.h"

namespace vantage {

/// Measures the rate of a counter over the last two seconds.
class RateMeter {
  public:
    /// Adds the counter's value, which never decreases.
    void add(std::uint64_t count, MonotonicTime now) {
        samples_.emplace_back(count, now);
        while (samples_.size() > 2 && now - samples_[1].second > window) samples_.pop_front();
    }
    double per_second() const {
        if (samples_.size() < 2) return 0;
        const double seconds =
            std::chrono::duration<double>(samples_.back().second - samples_.front().second).count();
        return seconds > 0
                   ? static_cast<double>(samples_.back().first - samples_.front().first) / seconds
                   : 0;
    }

  private:
    static constexpr std::chrono::seconds window{2};
    std::deque<std::pair<std::uint64_t, MonotonicTime>> samples_;
};

}  // namespace vantage
