#pragma once

#include <chrono>
#include <optional>

#include "common/receive/rig_status.h"

namespace vantage {

/// What the programme shows, as the operator has to know it.
enum class SignalState {
    live,      ///< the stage now
    hold,      ///< an instant that the operator holds or replays
    stale,     ///< the newest instant, but no frame set has come for a while
    no_signal  ///< no rig delivers frames
};

/// Stale: the newest frame set is older than a period plus this.
inline constexpr std::chrono::milliseconds stale_after{500};
/// No signal: the newest frame set is older than a period plus this.
inline constexpr std::chrono::milliseconds no_signal_after{3000};

/// `held`: the operator asked for a picture that is not the newest. `period`: of the trigger.
SignalState signal_state(const ReceiverStatus& status, bool held, std::chrono::nanoseconds period,
                         MonotonicTime now);

/// For people: "LIVE", "HOLD", "STALE", "NO SIGNAL".
const char* title_of(SignalState state);
/// For JSON: "live", "hold", "stale", "no_signal".
const char* key_of(SignalState state);

}  // namespace vantage
