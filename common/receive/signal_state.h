#pragma once

#include <chrono>
#include <optional>

#include "common/receive/rig_status.h"

namespace vantage {

/// What the picture that is shown is, as the operator must know it.
enum class SignalState {
    live,      ///< the stage as it is now
    hold,      ///< an instant that the operator holds, or goes back to
    stale,     ///< the newest instant, but the rigs have given none for a while
    no_signal  ///< no rig gives pictures
};

/// The newest set may be older than the period by so much before it is stale...
inline constexpr std::chrono::milliseconds stale_after{500};
/// ...and by so much before nobody can take it for a signal.
inline constexpr std::chrono::milliseconds no_signal_after{3000};

/// `held`: the picture shown is not the newest one, as the operator asked for. `period`: of the
/// stage's pulses.
SignalState signal_state(const ReceiverStatus& status, bool held, std::chrono::nanoseconds period,
                         MonotonicTime now);

/// For people: "LIVE", "HOLD", "STALE", "NO SIGNAL".
const char* title_of(SignalState state);
/// For machines: "live", "hold", "stale", "no_signal".
const char* key_of(SignalState state);

}  // namespace vantage
