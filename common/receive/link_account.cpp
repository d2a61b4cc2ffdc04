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
    const bool is_new_link = message.link != link_;
    const std::uint64_t expected = (is_new_link ? 0 : by_tcp_) + (with_frame ? 1 : 0);
    const std::uint64_t sent = message.counters.sent - message.sent_by_datagrams;
    if (sent < expected)
        fail("rig {} counts {} frames sent where {} came already", message.rig, sent, expected);
    std::uint64_t lost = sent - expected;
    if (is_new_link) {
        lost += sent_by_datagrams_ - std::min(sent_by_datagrams_, by_datagrams_);
        by_datagrams_ = 0;
    }
    if (is_new_link || message.offer.id != offer_) {
        lost += message.sent_by_datagrams - std::min(message.sent_by_datagrams, by_datagrams_);
        by_datagrams_ = message.sent_by_datagrams;
    }
    take_counts(message);
    sent_by_datagrams_ = message.sent_by_datagrams;
    link_ = message.link;
    offer_ = message.offer.id;
    by_tcp_ = sent;
    lost_ += lost;
    return lost;
}

std::uint64_t LinkAccount::hear_datagrams(const RigMessage& message) {
    if (message.link != link_ || message.offer.id != offer_)
        fail("rig {} sent a frame by datagrams of an earlier connection", message.rig);
    const std::uint64_t expected = by_datagrams_ + 1;
    if (message.sent_by_datagrams < expected)
        fail("rig {} counts {} frames sent by datagrams where {} came already", message.rig,
             message.sent_by_datagrams, expected);
    const std::uint64_t lost = message.sent_by_datagrams - expected;
    take_counts(message);
    by_datagrams_ = message.sent_by_datagrams;
    sent_by_datagrams_ = std::max(sent_by_datagrams_, by_datagrams_);
    lost_ += lost;
    return lost;
}

void LinkAccount::take_counts(const RigMessage& message) {
    // One road overtakes the other.
    const auto ended = [](const LinkCounters& c) { return c.sent + c.send_dropped + c.skipped; };
    if (message.link == link_ && ended(message.counters) < ended(this_link_)) return;
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
