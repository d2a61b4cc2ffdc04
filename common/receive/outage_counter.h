#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/time/time.h"

namespace vantage {

/// Counts the outages of a rig and their total time. Clock readings are arguments. Not thread-safe.
class OutageCounter {
  public:
    /// Call it periodically. `heard`: the rig's last message, from which an outage counts.
    void note(bool connected, std::optional<MonotonicTime> heard);

    /// Ends the count: the time until note() is called again is no outage.
    void leave(MonotonicTime now);

    /// Number of outages, including a current one.
    std::uint64_t outages() const { return outages_; }
    std::chrono::nanoseconds length(MonotonicTime now) const;

  private:
    bool was_connected_ = false;
    std::uint64_t outages_ = 0;
    std::chrono::nanoseconds ended_{0};
    std::optional<MonotonicTime> since_;  ///< start of the current outage
};

}  // namespace vantage
