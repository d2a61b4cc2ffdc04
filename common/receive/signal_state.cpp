#include "common/receive/signal_state.h"

#include <algorithm>

namespace vantage {

SignalState signal_state(const ReceiverStatus& status, bool held, std::chrono::nanoseconds period,
                         MonotonicTime now) {
    if (held) return SignalState::hold;
    const bool any_rig =
        std::any_of(status.rigs.begin(), status.rigs.end(),
                    [&](const RigStatus& rig) { return gives_pictures(rig, status.rigs); });
    if (!any_rig || !status.newest_frame_set) return SignalState::no_signal;
    const std::chrono::nanoseconds age = now - *status.newest_frame_set;
    if (age > period + no_signal_after) return SignalState::no_signal;
    return age > period + stale_after ? SignalState::stale : SignalState::live;
}

const char* title_of(SignalState state) {
    switch (state) {
        case SignalState::live:
            return "LIVE";
        case SignalState::hold:
            return "HOLD";
        case SignalState::stale:
            return "STALE";
        case SignalState::no_signal:
            break;
    }
    return "NO SIGNAL";
}

const char* key_of(SignalState state) {
    switch (state) {
        case SignalState::live:
            return "live";
        case SignalState::hold:
            return "hold";
        case SignalState::stale:
            return "stale";
        case SignalState::no_signal:
            break;
    }
    return "no_signal";
}

}  // namespace vantage
