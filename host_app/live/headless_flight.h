#pragma once

#include <cstdint>

#include "common/base/stop_signal.h"
#include "host_app/live/flight_controls.h"

namespace vantage {

/// Makes pictures at the output's rate and in real time until the flight is over or the program is
/// asked to stop: as the plan says, else at the end of a move that does not loop,
/// unless there is a deck: then its wheels fly. Logs
/// progress every few seconds. Returns the ticks of the output that passed without a picture.
std::uint64_t fly_headless(LiveSession& session, const FlightPlan& plan, JogDeck* deck,
                           double rate_hz, StopSignal& stop);

}  // namespace vantage
