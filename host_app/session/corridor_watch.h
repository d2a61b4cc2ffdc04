#pragma once

#include <vector>

#include "host_app/flight/moves/move_coverage.h"
#include "host_app/session/live_show.h"

namespace vantage {

/// Says in the log, once each, that the camera nears the end of its corridor and that it is beyond
/// it, and where a planned move leaves it.
class CorridorWatch {
  public:
    explicit CorridorWatch(const FlightPlan& plan) : move_(plan.move) {}

    /// To be called often.
    void tell(const LiveShow& show);
    /// Of the planned move; empty before the stage is known, and without one.
    const std::vector<UncoveredPart>& uncovered_parts() const { return parts_; }

  private:
    void check_move(const LiveShow& show);

    std::optional<Move> move_;  ///< nothing once it is checked
    std::vector<UncoveredPart> parts_;
    bool told_edge_ = false, told_beyond_ = false;
};

}  // namespace vantage
