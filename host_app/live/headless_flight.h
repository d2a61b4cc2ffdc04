#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "common/base/stop_signal.h"
#include "host_app/flight/move.h"
#include "host_app/live/live_session.h"

namespace vantage {

struct HeadlessFlight {
    OrbitView start;
    std::optional<Move> move;             ///< without one the camera stands at `start`
    std::optional<std::uint64_t> frames;  ///< pictures to make; else to the end of the move
};

/// Makes pictures at the output's rate and in real time until the flight is over or the program is
/// asked to stop: after `frames` pictures; else at the end of a move that does not loop. Logs
/// progress every few seconds. Returns the ticks of the output that passed without a picture.
std::uint64_t fly_headless(LiveSession& session, const HeadlessFlight& flight, double rate_hz,
                           StopSignal& stop);

}  // namespace vantage
