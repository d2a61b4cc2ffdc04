#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "common/base/time/time.h"

namespace vantage {

/// Sign of life of a worker thread. The worker beats in every round of its loop, with or without
/// work. A worker that hangs in a driver, a GPU or a file system stops beating. Thread-safe.
class Heartbeat {
  public:
    explicit Heartbeat(std::string worker) : worker_(std::move(worker)) {}

    const std::string& worker() const { return worker_; }
    void beat(MonotonicTime now = MonotonicClock::now()) { last_ns_ = to_ns(now); }
    /// Marks the worker as not started or as ended in order, so that no beat is expected.
    void rest() { last_ns_ = resting; }
    /// Time since the last beat; 0 for a worker that has not started or has ended.
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
