#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/flight/moves/move.h"
#include "host_app/session/live_show.h"

namespace vantage {

/// Logs a line about a running show every two seconds.
class ProgressLog {
  public:
    explicit ProgressLog(const FlightPlan& plan) : frames_(plan.frames) {}

    /// Logs a line if it is due. Call it often.
    void tell(const LiveShow& show);
    /// Returns the line for the time since the last one.
    std::string line(const LiveShow& show);

  private:
    std::optional<std::uint64_t> frames_;
    MonotonicTime last_ = MonotonicClock::now();
    // Counts at the time of the last line.
    std::uint64_t pictures_ = 0, reprojected_ = 0, repeated_ = 0, instants_ = 0;
};

/// Logs that this computer is short of memory when it begins to be, and when that ends.
class ComputerWatch {
  public:
    /// Call it often.
    void tell();

  private:
    MonotonicTime last_ = MonotonicClock::now();
    bool is_short_ = false;
};

/// Logs once each that the camera reaches the edge of its corridor, that it leaves the corridor,
/// and which parts of the planned move lie outside.
class CorridorWatch {
  public:
    explicit CorridorWatch(const FlightPlan& plan) : move_(plan.move) {}

    /// Checks the camera and, once the stage is known, the planned move. Call it often.
    void tell(const LiveShow& show);
    /// The parts of the planned move outside the corridor; empty while the stage is unknown.
    const std::vector<UncoveredPart>& uncovered_parts() const { return parts_; }

  private:
    void check_move(const LiveShow& show);

    std::optional<Move> move_;  ///< nothing: there is none, or it is checked
    std::vector<UncoveredPart> parts_;
    bool told_edge_ = false, told_beyond_ = false;
};

}  // namespace vantage
