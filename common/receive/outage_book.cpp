#include "common/receive/outage_book.h"

namespace vantage {

void OutageBook::note(bool connected, std::optional<MonotonicTime> heard) {
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

std::chrono::nanoseconds OutageBook::length(MonotonicTime now) const {
    return ended_ + (since_ ? now - *since_ : std::chrono::nanoseconds(0));
}

}  // namespace vantage
