#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/time/time.h"

namespace vantage {

/// Notices that CLOCK_TAI was set: compares how far it advances with how far CLOCK_MONOTONIC does.
/// A clock that is only trimmed (at most 0.05 % of the time that passes) is no step. One thread.
class ClockStepWatch {
  public:
    /// A smaller difference is not called a step.
    static constexpr std::chrono::milliseconds least_step{100};

    /// Both clocks read at one moment. Returns by how much CLOCK_TAI was set forward (negative:
    /// back) since the last call, if it was set.
    std::optional<std::chrono::nanoseconds> observe(MonotonicTime monotonic, TaiTime tai) {
        const std::chrono::nanoseconds ahead =
            tai.time_since_epoch() - monotonic.time_since_epoch();
        if (!last_) {
            last_ = {monotonic, ahead};
            return std::nullopt;
        }
        const std::chrono::nanoseconds step = ahead - last_->ahead;
        const std::chrono::nanoseconds trimmed = (monotonic - last_->monotonic) / 1000;
        last_ = {monotonic, ahead};
        if (step <= least_step + trimmed && -step <= least_step + trimmed) return std::nullopt;
        ++steps_;
        last_step_ = step;
        return step;
    }
    /// Reads the clocks itself.
    std::optional<std::chrono::nanoseconds> look() {
        return observe(MonotonicClock::now(), TaiClock::now());
    }

    std::uint64_t steps() const { return steps_; }
    std::chrono::nanoseconds last_step() const { return last_step_; }

  private:
    struct Reading {
        MonotonicTime monotonic{};
        std::chrono::nanoseconds ahead{};
    };
    std::optional<Reading> last_;
    std::uint64_t steps_ = 0;
    std::chrono::nanoseconds last_step_{};
};

}  // namespace vantage
