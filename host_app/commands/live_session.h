#pragma once

#include <functional>
#include <string>

#include "host_app/session/show_session.h"

namespace vantage {

/// The options of `vantage live`.
struct LiveOptions {
    ShowOptions show;
    std::string stage;  ///< stage file
    std::string take;   ///< take that is recorded from the start; empty: none
    std::string takes;  ///< folder of the takes that the operator starts; empty: the working folder
    double wait_s = 10, past_mb = 1024, pre_roll_s = 0;
    /// Called while the first pictures are waited for; what it throws ends the session. Empty:
    /// nothing is called.
    std::function<void()> while_waiting{};
};

/// Runs a live session from the rigs' first frame to the summary. Call it before any other thread
/// is started. Throws Error for faults of options, files, devices and rigs.
void run_live_session(const LiveOptions& options);

}  // namespace vantage
