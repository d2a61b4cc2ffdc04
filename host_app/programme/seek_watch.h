#pragma once

#include <cstdint>
#include <optional>

#include "common/base/percentiles.h"
#include "common/base/time/time.h"
#include "host_app/pipeline/instant_thread.h"

namespace vantage {

/// Where the time goes between a jump in time and its picture.
template <class Time>
struct SeekSteps {
    Time wait;     ///< for the instant that was being prepared
    Time fetch;    ///< the set: read, decoded
    Time prepare;  ///< its instant
    Time picture;  ///< rendering, and the waits for its turn and for the tick
};

/// Jumps in time, each until the picture of where it led is handed over.
class SeekWatch {
  public:
    /// Whether time has jumped since it was followed last; `jumps` so far.
    bool has_jumped(std::uint64_t jumps) const { return jumps != jumps_; }
    /// `stands_at`: the pulse that time stands at, if it is in the past and there is one; `shown`:
    /// that of the last picture.
    void follow(std::uint64_t jumps, std::optional<std::uint64_t> stands_at,
                std::optional<std::uint64_t> shown, MonotonicTime now);
    /// A jump is waited for.
    bool is_on() const { return seek_.has_value(); }
    /// A picture of this instant is handed over while time, which goes on meanwhile, stands at
    /// `stands_at`.
    void saw(const ReadyInstant& instant, std::optional<std::uint64_t> stands_at,
             MonotonicTime now);

    Percentiles all_ms() const { return all_ms_.summary(); }
    SeekSteps<Percentiles> steps_ms() const;

  private:
    struct Seek {
        MonotonicTime since;
        std::uint64_t pulse;  ///< that it led to
    };
    std::optional<Seek> seek_;
    std::uint64_t jumps_ = 0;
    PercentileRecorder all_ms_;
    SeekSteps<PercentileRecorder> steps_ms_;
};

}  // namespace vantage
