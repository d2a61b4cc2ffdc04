#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "common/wire/link_message.h"

namespace vantage {

/// Accounts for the frames of one rig at the host, since the host's first message from it. Messages
/// of a connection keep their order and state the number of frames sent, so that a lost frame is
/// known with the next message.
///
/// Frames come over TCP or by datagrams, and each road numbers its own. Frames by datagrams that
/// have not come are under way, until a message over TCP names another offer of datagrams, or
/// another link: they are lost then.
///
/// A rig counts from the start of its daemon. Here the counts are summed over restarts, and counts
/// from before this host's first message are subtracted, so that they are comparable with the
/// host's own counts. Not thread-safe.
class LinkAccount {
  public:
    /// Takes a message over TCP in, with or without a frame. Returns the number of frames found
    /// lost. Throws Error if the rig's count decreased; the caller then ignores the message.
    std::uint64_t hear(const RigMessage& message, bool with_frame);
    /// Takes the message of a frame in that came by datagrams. Throws Error also if it is of
    /// another link or offer than the last message over TCP.
    std::uint64_t hear_datagrams(const RigMessage& message);

    /// The id that the rig gave this host's link; 0: none yet.
    std::uint64_t link() const { return link_; }
    /// Number of frames on this link that came or were lost.
    std::uint64_t known() const { return by_tcp_ + by_datagrams_; }
    /// Number of frames on this link that the host has finished with, where `unhandled` of those
    /// that came (on this link or an earlier one) are not decoded yet.
    std::uint64_t handled(std::uint64_t unhandled) const {
        return known() - std::min(known(), unhandled);
    }
    /// Number of frames lost on all links.
    std::uint64_t lost() const { return lost_; }

    /// The sum over all links.
    LinkCounters link_counters() const;
    /// The rig's counts since this host's first message from it.
    RigCounters rig_counters() const;
    /// Number of restarts of the rig's daemon since then.
    std::uint64_t restarts() const { return restarts_; }

  private:
    void take_counts(const RigMessage& message);

    std::uint64_t link_ = 0;
    std::uint64_t offer_ = 0;  ///< of datagrams
    // Frames on this link that came or were lost.
    std::uint64_t by_tcp_ = 0, by_datagrams_ = 0;
    std::uint64_t sent_by_datagrams_ = 0;  ///< as the rig last counted
    std::uint64_t lost_ = 0;
    std::uint64_t restarts_ = 0;
    std::optional<std::uint64_t> session_;
    LinkCounters ended_links_, this_link_;
    RigCounters ended_sessions_, this_session_;
    RigCounters before_;  ///< counts of this daemon session from before the host's first message
};

}  // namespace vantage
