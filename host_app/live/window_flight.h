#pragma once

#include <cstdint>
#include <optional>

#include "common/base/stop_signal.h"
#include "host_app/flight/move.h"
#include "host_app/live/live_session.h"
#include "host_app/ui/operator_window.h"

namespace vantage {

struct WindowFlight {
    OrbitView start;
    std::optional<Move> move;             ///< plays at first; the operator may take over
    std::optional<std::uint64_t> frames;  ///< pictures after which it ends by itself
    bool recording = false;
};

/// Lets the operator fly until the window is closed, the pictures are made, or the program is asked
/// to stop. Returns the ticks of the output that passed without a picture.
std::uint64_t fly_in_window(LiveSession& session, OperatorWindow& window,
                            const WindowFlight& flight, double rate_hz, StopSignal& stop);

}  // namespace vantage
