#pragma once

#include <cstdint>

#include "common/base/stop_signal.h"
#include "host_app/live/flight_plan.h"
#include "host_app/live/live_session.h"
#include "host_app/ui/operator_window.h"

namespace vantage {

/// Lets the operator fly until the window is closed, the pictures are made, or the program is asked
/// to stop. Returns the ticks of the output that passed without a picture.
std::uint64_t fly_in_window(LiveSession& session, OperatorWindow& window, const FlightPlan& plan,
                            double rate_hz, StopSignal& stop);

}  // namespace vantage
