#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/rate_meter.h"
#include "common/take/take_recorder.h"
#include "host_app/desk/air_verdict.h"
#include "host_app/session/live_show.h"

namespace vantage {

/// Whether the programme is fit to go on air, for control surfaces and the page for tablets. Used
/// on the session's thread; it costs the programme's thread nothing.
class AirWatch {
  public:
    struct Seen {
        LiveReport report;
        AirVerdict verdict;
        std::vector<DeskRig> rigs;  ///< in the order of the report
    };
    /// Looks again if the last time was a quarter of a second ago, and returns whether it did.
    /// `take` is nothing if none was recorded.
    bool follow(const LiveShow& show, const std::optional<TakeState>& take, MonotonicTime now);
    /// Empty before the first look.
    const std::optional<Seen>& seen() const { return seen_; }

  private:
    std::map<std::string, MonotonicTime> rigs_seen_;  ///< last time in a frame set
    RateMeter ticks_, repeats_;
    MonotonicTime refreshed_{};
    std::optional<Seen> seen_;
};

/// "ready", "caution" or "not_ready".
const char* key_of(AirVerdict::Level level);

}  // namespace vantage
