#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "host_app/sets/stage_feed.h"

namespace vantage {

/// The last sets that came, for going back to them: as many as fit into a stated memory, the oldest
/// leave first. Sets share their frames with whoever else has them. Safe to use from any thread.
class ReplayBuffer {
  public:
    explicit ReplayBuffer(std::size_t max_bytes) : max_bytes_(max_bytes) {}

    /// Sets come in the order of their pulses; one of an earlier pulse than the newest begins anew,
    /// since the stage has. A set that does not fit alone is not kept.
    void add(const FrameSet& set);

    /// The newest set that is not later than the pulse, else the oldest there is; empty if none is.
    std::optional<FrameSet> at(double pulse) const;

    struct Span {
        std::uint64_t oldest = 0, newest = 0;  ///< pulses
        std::size_t sets = 0, bytes = 0;
    };
    /// Empty if nothing is kept.
    std::optional<Span> span() const;

  private:
    struct Kept {
        FrameSet set;
        std::size_t bytes = 0;
    };
    std::size_t max_bytes_;
    mutable std::mutex mutex_;
    std::deque<Kept> kept_;
    std::size_t bytes_ = 0;
};

/// The same feed, of which every set that is taken is kept too. The ring must outlive it.
StageFeed kept_feed(StageFeed feed, ReplayBuffer& ring);

}  // namespace vantage
