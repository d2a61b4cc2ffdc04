#pragma once

#include <cstdint>

#include "common/wire/link_message.h"

namespace vantage {

/// The host's book of one rig's link. Messages of a connection keep their order, and each says how
/// many frames were sent so far, so every frame that was sent and did not come is known as soon as
/// anything comes after it.
class LinkAccount {
  public:
    /// A message came, with a frame or without. Returns the number of frames found lost. Throws
    /// Error if the rig's count goes backwards; the message is then to be ignored.
    std::uint64_t hear(const RigMessage& message, bool with_frame);

    /// The link the rig has put this host on; 0: none yet.
    std::uint64_t link() const { return link_; }
    /// Frames of this link that are accounted for: came or lost.
    std::uint64_t known() const { return known_; }
    /// Lost on all links so far.
    std::uint64_t lost() const { return lost_; }

  private:
    std::uint64_t link_ = 0;
    std::uint64_t known_ = 0;
    std::uint64_t lost_ = 0;
};

}  // namespace vantage
