#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "common/wire/frame_codec.h"
#include "host_app/frames/past_frame_sets.h"
#include "host_app/frames/stage_feed.h"

namespace vantage {

/// The newest frame sets of a stage, as many as fit into a given amount of memory. Frames are kept
/// as they arrived, at about a tenth of their decoded size, and decoded on access. Frames that did
/// not come over the network are kept decoded. Thread-safe.
class ReplayBuffer final : public PastFrameSets {
  public:
    explicit ReplayBuffer(std::size_t max_bytes) : max_bytes_(max_bytes) {}

    /// Adds a frame set and drops the oldest to stay within the memory. Pulses increase; a frame
    /// set with an earlier pulse clears the buffer, since the stage was restarted. A frame set that
    /// is larger than the buffer is not kept.
    void add(const FrameSet& set);

    std::optional<std::uint64_t> pulse_at(double pulse) const override;
    std::optional<FrameSet> at(double pulse) const override;
    std::optional<Span> span() const override;

  private:
    struct Slot {
        std::string rig;
        std::shared_ptr<const PackedFrame> packed;
        std::shared_ptr<const RigFrame> frame;  ///< if `packed` is null
        Absence absence = Absence::none;
    };
    struct Kept {
        std::uint64_t trigger_index = 0;
        MonotonicTime complete{};
        std::vector<Slot> slots;
        std::size_t bytes = 0;
    };
    static Kept kept_of(const FrameSet& set);
    /// Null if the buffer is empty. Precondition: mutex_ is held.
    const Kept* find(double pulse) const;

    std::size_t max_bytes_;
    mutable std::mutex mutex_;
    std::deque<Kept> kept_;
    std::size_t bytes_ = 0;
};

/// A feed that also adds every frame set to a replay buffer, which must outlive it.
StageFeed kept_feed(StageFeed feed, ReplayBuffer& ring);

}  // namespace vantage
