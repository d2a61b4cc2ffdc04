#pragma once

#include <atomic>

#include "common/base/time/time.h"

namespace vantage {

/// Time for which an output may wait for its peer or device. Unlimited until the output is stopped.
class OutputPatience {
  public:
    bool is_over() const { return to_ns(MonotonicClock::now()) >= until_ns_; }
    void ends_after(std::chrono::nanoseconds time) {
        until_ns_ = to_ns(MonotonicClock::now() + time);
    }
    void is_endless() { until_ns_ = endless_ns; }

  private:
    static constexpr std::int64_t endless_ns = INT64_MAX;
    std::atomic<std::int64_t> until_ns_ = endless_ns;
};

}  // namespace vantage
