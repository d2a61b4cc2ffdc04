#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "common/wire/link_message.h"

namespace vantage {

/// The host's book of one rig, from the first word it heard of it. Messages of a connection keep
/// their order, and each says how many frames were sent so far, so every frame that was sent and
/// did not come is known as soon as anything comes after it.
///
/// A rig counts frames from its start, and anew when its daemon is started anew. Here those counts
/// are added up over all of its sessions, and what it counted before this host came is taken off,
/// so that they stand beside the host's own.
class LinkAccount {
  public:
    /// A message came, with a frame or without. Returns the number of frames found lost. Throws
    /// Error if the rig's count goes backwards; the message is then to be ignored.
    std::uint64_t hear(const RigMessage& message, bool with_frame);

    /// The link the rig has put this host on; 0: none yet.
    std::uint64_t link() const { return link_; }
    /// Frames of this link that are accounted for: came or lost.
    std::uint64_t known() const { return known_; }
    /// Frames of this link that the host is done with, when so many of those that came (on this
    /// link or an earlier one) are not decoded yet.
    std::uint64_t handled(std::uint64_t unhandled) const {
        return known_ - std::min(known_, unhandled);
    }
    /// Lost on all links so far.
    std::uint64_t lost() const { return lost_; }

    /// Of all links.
    LinkCounters link_counters() const;
    /// Since this host heard of the rig first.
    RigCounters rig_counters() const;
    /// How often the rig's daemon was started anew since.
    std::uint64_t restarts() const { return restarts_; }

  private:
    void take_counts(const RigMessage& message);

    std::uint64_t link_ = 0;
    std::uint64_t known_ = 0;
    std::uint64_t lost_ = 0;
    std::uint64_t restarts_ = 0;
    std::optional<std::uint64_t> session_;
    LinkCounters ended_links_, this_link_;
    RigCounters ended_sessions_, this_session_;
    RigCounters before_;  ///< what this session had counted when this host came
};

}  // namespace vantage
