#pragma once

#include <cstdint>
#include <optional>

#include "common/base/percentiles.h"
#include "common/base/time/time.h"
#include "host_app/pipeline/instant_thread.h"

namespace vantage {

/// Parts of the time between a jump in time and the frame of its target.
template <class Time>
struct SeekSteps {
    Time wait;     ///< for the instant that was being prepared
    Time fetch;    ///< reading and decoding the frame set
    Time prepare;  ///< preparing its instant
    Time picture;  ///< rendering, and the waits for render priority and for the tick
};

/// Measures jumps in time, each until the frame of its target is handed over. Not thread-safe.
class SeekWatch {
  public:
    /// Whether there was a jump since follow(); `jumps` is the number so far.
    bool has_jumped(std::uint64_t jumps) const { return jumps != jumps_; }
    /// Starts to measure a new jump. `stands_at` is the pulse of the playback position, empty
    /// unless in the past; `shown` is the pulse on screen.
    void follow(std::uint64_t jumps, std::optional<std::uint64_t> stands_at,
                std::optional<std::uint64_t> shown, MonotonicTime now);
    /// Whether the frame of a jump is still awaited.
    bool is_on() const { return seek_.has_value(); }
    /// Records that a frame of this instant is handed over. `stands_at` is the pulse of the present
    /// playback position, which may have moved on.
    void saw(const ReadyInstant& instant, std::optional<std::uint64_t> stands_at,
             MonotonicTime now);

    Percentiles all_ms() const { return all_ms_.summary(); }
    SeekSteps<Percentiles> steps_ms() const;

  private:
    struct Seek {
        MonotonicTime since;
        std::uint64_t pulse;  ///< target
    };
    std::optional<Seek> seek_;
    std::uint64_t jumps_ = 0;
    PercentileRecorder all_ms_;
    SeekSteps<PercentileRecorder> steps_ms_;
};

}  // namespace vantage
