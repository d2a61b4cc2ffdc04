#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/time/time.h"

namespace vantage {

/// Lets a line about something that may come in floods be written once in a while, and counts what
/// it stands for.
class LogLimiter {
  public:
    explicit LogLimiter(std::chrono::nanoseconds period) : period_(period) {}

    /// It came `times` more. How often it came since the last line, if a line is due.
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
