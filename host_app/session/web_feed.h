#pragma once

#include <map>
#include <optional>
#include <string>

#include "common/base/time/rate_meter.h"
#include "common/take/take_recorder.h"
#include "host_app/control/table/lamp.h"
#include "host_app/session/live_show.h"
#include "host_app/web/web_server.h"

namespace vantage {

/// Serves the page for tablets and phones, and keeps it up to date with a show: the picture at
/// every call, and the state four times a second. Used on the session's thread; it costs the
/// programme's thread nothing.
class WebFeed {
  public:
    /// Throws Error as WebServer does. `input` must outlive it.
    WebFeed(const std::string& url, OperatorInputBox& input);

    /// `take` is nothing if none was recorded.
    void follow(const LiveShow& show, const std::optional<TakeState>& take, const ShowLamps& lamps,
                MonotonicTime now);

  private:
    std::string state_of(const LiveShow& show, const ProgrammeState& programme,
                         const std::optional<TakeState>& take, const ShowLamps& lamps,
                         MonotonicTime now);

    WebServer server_;
    bool has_control_;
    std::map<std::string, MonotonicTime> rigs_seen_;  ///< last time in a frame set
    RateMeter ticks_, repeats_;
    std::optional<MonotonicTime> refreshed_;
    std::string state_ = "{}";
};

}  // namespace vantage
