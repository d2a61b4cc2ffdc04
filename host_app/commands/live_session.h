#pragma once

#include <functional>
#include <string>

#include "host_app/session/show_session.h"

namespace vantage {

struct LiveOptions {
    ShowOptions show;
    std::string stage;        ///< its file
    std::string take, takes;  ///< recorded from the start; folder of those begun by hand
    double wait_s = 10, past_mb = 1024, pre_roll_s = 0;
    /// Called while the first pictures are waited for; what it throws ends the session. Empty: nothing
    /// is called.
    std::function<void()> while_waiting{};
};

/// A live stage from its rigs' first frame to the summary. Throws Error for what a person, a file
/// or a device caused. To be called before any other thread is started.
void run_live_session(const LiveOptions& options);

}  // namespace vantage
