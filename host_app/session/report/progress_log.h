#pragma once

#include <string>

#include "common/base/time/time.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/session/live_show.h"

namespace vantage {

/// A line in the log every other second of a flight.
class ProgressLog {
  public:
    explicit ProgressLog(const FlightPlan& plan) : frames_(plan.frames) {}

    /// To be called often.
    void tell(const LiveShow& show);
    /// That line, of what has passed since the last one.
    std::string line(const LiveShow& show);

  private:
    std::optional<std::uint64_t> frames_;
    MonotonicTime last_ = MonotonicClock::now();
    std::uint64_t pictures_ = 0, reprojected_ = 0, repeated_ = 0, instants_ = 0;  ///< by then
};

}  // namespace vantage
