#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "common/base/time/time.h"

namespace vantage {

/// How often, and for how long in all, a rig that had been connected was not. Clocks come in as
/// arguments.
class OutageBook {
  public:
    /// To be told again and again. `heard`: the rig's last word; an outage counts from there.
    void note(bool connected, std::optional<MonotonicTime> heard);

    /// Those that came to an end and the one that lasts.
    std::uint64_t outages() const { return outages_; }
    std::chrono::nanoseconds length(MonotonicTime now) const;

  private:
    bool was_connected_ = false;
    std::uint64_t outages_ = 0;
    std::chrono::nanoseconds ended_{0};
    std::optional<MonotonicTime> since_;  ///< of the one that lasts
};

}  // namespace vantage
