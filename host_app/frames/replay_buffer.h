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

/// The last sets that came, for going back to them: as many as fit into a stated memory, the oldest
/// leave first. Frames are kept as they came over the wire, a tenth of what they are decoded, and
/// decoded when they are asked for; one that came over no wire is kept as it is. Safe to use from
/// any thread.
class ReplayBuffer final : public PastFrameSets {
  public:
    explicit ReplayBuffer(std::size_t max_bytes) : max_bytes_(max_bytes) {}

    /// Sets come in the order of their pulses; one of an earlier pulse than the newest begins anew,
    /// since the stage has. A set that does not fit alone is not kept.
    void add(const FrameSet& set);

    std::optional<std::uint64_t> pulse_at(double pulse) const override;
    std::optional<FrameSet> at(double pulse) const override;
    std::optional<Span> span() const override;

  private:
    struct Slot {
        std::string rig;
        std::shared_ptr<const PackedFrame> packed;
        std::shared_ptr<const RigFrame> frame;  ///< where there is no packed one
        Absence absence = Absence::none;
    };
    struct Kept {
        std::uint64_t trigger_index = 0;
        MonotonicTime complete{};
        std::vector<Slot> slots;
        std::size_t bytes = 0;
    };
    static Kept kept_of(const FrameSet& set);
    const Kept* find(double pulse) const;

    std::size_t max_bytes_;
    mutable std::mutex mutex_;
    std::deque<Kept> kept_;
    std::size_t bytes_ = 0;
};

/// The same feed, of which every set that is taken is kept too. The ring must outlive it.
StageFeed kept_feed(StageFeed feed, ReplayBuffer& ring);

}  // namespace vantage
