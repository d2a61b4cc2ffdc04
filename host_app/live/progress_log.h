#pragma once

#include "common/base/time.h"
#include "host_app/live/flight_plan.h"
#include "host_app/live/live_session.h"

namespace vantage {

/// A line in the log every other second of a flight.
class ProgressLog {
  public:
    explicit ProgressLog(const FlightPlan& plan) : frames_(plan.frames) {}

    /// To be told of every picture; `pictures` are made so far.
    void tell(LiveSession& session, std::uint64_t pictures);

  private:
    std::optional<std::uint64_t> frames_;
    MonotonicTime start_ = MonotonicClock::now(), last_ = start_;
};

}  // namespace vantage
