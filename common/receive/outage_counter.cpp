#include "common/receive/outage_counter.h"

namespace vantage {

void OutageCounter::note(bool connected, std::optional<MonotonicTime> heard) {
    if (was_connected_ && !connected) {
        ++outages_;
        since_ = heard;
    }
    if (connected && since_ && heard) {
        ended_ += *heard - *since_;
        since_.reset();
    }
    was_connected_ = connected;
}

void OutageCounter::leave(MonotonicTime now) {
    ended_ = length(now);
    since_.reset();
    was_connected_ = false;
}

std::chrono::nanoseconds OutageCounter::length(MonotonicTime now) const {
    return ended_ + (since_ ? now - *since_ : std::chrono::nanoseconds(0));
}

}  // namespace vantage
