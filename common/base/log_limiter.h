#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/time/time.h"

namespace vantage {

/// Limits how often a log line about a frequent event is written, and counts the events between
/// two lines.
class LogLimiter {
  public:
    explicit LogLimiter(std::chrono::nanoseconds period) : period_(period) {}

    /// Counts `times` more events. If a line is due, returns the number of events since the last.
    std::optional<std::uint64_t> count(std::uint64_t times, MonotonicTime now) {
        since_ += times;
        if (since_ == 0 || (last_ && now - *last_ < period_)) return std::nullopt;
        last_ = now;
        const std::uint64_t all = since_;
        since_ = 0;
        return all;
    }

  private:
    std::chrono::nanoseconds period_;
    std::uint64_t since_ = 0;
    std::optional<MonotonicTime> last_;
};

}  // namespace vantage
