#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "common/base/time/time.h"

namespace vantage {

/// A worker's sign of life: it beats whenever the worker comes round its loop, with or without
/// work. What a worker is stuck in (a driver, a GPU, a file system) keeps it from beating.
class Heartbeat {
  public:
    explicit Heartbeat(std::string worker) : worker_(std::move(worker)) {}

    const std::string& worker() const { return worker_; }
    void beat(MonotonicTime now = MonotonicClock::now()) { last_ns_ = to_ns(now); }
    /// The worker has not begun or has ended in order: nothing is expected of it.
    void rest() { last_ns_ = resting; }
    /// Time since the last beat; 0 of a worker that rests.
    std::chrono::nanoseconds silence(MonotonicTime now = MonotonicClock::now()) const {
        const std::int64_t last_ns = last_ns_;
        return std::chrono::nanoseconds(last_ns == resting ? 0 : to_ns(now) - last_ns);
    }

  private:
    static constexpr std::int64_t resting = -1;
    std::string worker_;
    std::atomic<std::int64_t> last_ns_ = resting;
};

}  // namespace vantage
