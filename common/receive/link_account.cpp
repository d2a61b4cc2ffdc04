#include "common/receive/link_account.h"

#include <utility>

#include "common/base/error.h"

namespace vantage {
namespace {

LinkCounters sum(const LinkCounters& a, const LinkCounters& b) {
    return {a.offered + b.offered, a.sent + b.sent, a.send_dropped + b.send_dropped,
            a.skipped + b.skipped};
}

RigCounters sum(const RigCounters& a, const RigCounters& b) {
    return {a.captured + b.captured, a.missed + b.missed, a.late + b.late,
            a.published + b.published, a.send_dropped + b.send_dropped};
}

/// Differences of at least 0: a rig's counts may be a frame apart from each other.
RigCounters difference(const RigCounters& a, const RigCounters& b) {
    const auto less = [](std::uint64_t x, std::uint64_t y) { return x - std::min(x, y); };
    return {less(a.captured, b.captured), less(a.missed, b.missed), less(a.late, b.late),
            less(a.published, b.published), less(a.send_dropped, b.send_dropped)};
}

}  // namespace

std::uint64_t LinkAccount::hear(const RigMessage& message, bool with_frame) {
    const std::uint64_t known_before = message.link == link_ ? known_ : 0;
    const std::uint64_t expected = known_before + (with_frame ? 1 : 0);
    const std::uint64_t sent = message.counters.sent;
    if (sent < expected)
        fail("rig {} counts {} frames sent where {} came already", message.rig, sent, expected);
    take_counts(message);
    link_ = message.link;
    known_ = sent;
    lost_ += sent - expected;
    return sent - expected;
}

void LinkAccount::take_counts(const RigMessage& message) {
    if (message.link != link_) ended_links_ = sum(ended_links_, std::exchange(this_link_, {}));
    this_link_ = message.counters;
    if (!session_) {
        before_ = message.rig_counters;
        // A frame that is inside the rig at this moment counts as captured from here on.
        before_.captured = std::min(before_.captured, before_.published + before_.late);
    } else if (*session_ != message.session) {
        ended_sessions_ = rig_counters();
        before_ = {};
        ++restarts_;
    }
    session_ = message.session;
    this_session_ = message.rig_counters;
}

LinkCounters LinkAccount::link_counters() const { return sum(ended_links_, this_link_); }

RigCounters LinkAccount::rig_counters() const {
    return sum(ended_sessions_, difference(this_session_, before_));
}

}  // namespace vantage
