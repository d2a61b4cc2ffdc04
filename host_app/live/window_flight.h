#pragma once

#include <cstdint>

#include "common/base/stop_signal.h"
#include "host_app/desk/operator_window.h"
#include "host_app/live/flight_controls.h"

namespace vantage {

/// Lets the operator fly until the window is closed, the pictures are made, or the program is asked
/// to stop. The wheels of the deck, if there is one, fly too. Returns the ticks of the output that
/// passed without a picture.
std::uint64_t fly_in_window(LiveSession& session, OperatorWindow& window, const FlightPlan& plan,
                            JogDeck* deck, double rate_hz, StopSignal& stop);

}  // namespace vantage
