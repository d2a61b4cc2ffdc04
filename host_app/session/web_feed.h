#pragma once

#include <optional>
#include <string>

#include "common/take/take_recorder.h"
#include "host_app/control/table/lamp.h"
#include "host_app/session/control_room.h"
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

    /// `seen` is the newest look of an AirWatch; `is_new` says that it is newer than at the last
    /// call. `take` is nothing if none was recorded.
    void follow(const LiveShow& show, const AirWatch::Seen& seen, bool is_new,
                const std::optional<TakeState>& take, const ShowLamps& lamps);

  private:
    std::string state_of(const AirWatch::Seen& seen, const std::optional<TakeState>& take,
                         const ShowLamps& lamps) const;

    WebServer server_;
    bool has_control_;
    std::string board_;  ///< the option board=
    std::string state_ = "{}";
};

}  // namespace vantage
