#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "common/take/format/frame_storage.h"
#include "common/take/take_reader.h"
#include "host_app/frames/past_frame_sets.h"
#include "host_app/frames/stage_feed.h"

namespace vantage {

/// The frame sets of a take, decoded with one thread per rig. At even steps, the next frame set is
/// decoded ahead; after a jump, the requested one is decoded first and alone. A damaged frame is
/// absent from its frame set and logged once. Not thread-safe.
class TakeFrameSets final : public PastFrameSets {
  public:
    /// Throws Error if the take has no frames.
    explicit TakeFrameSets(std::shared_ptr<const TakeReader> take);
    ~TakeFrameSets() override;

    std::optional<std::uint64_t> pulse_at(double pulse) const override;
    std::optional<FrameSet> at(double pulse) const override;
    std::optional<Span> span() const override;

  private:
    struct Rig {
        std::string name;
        std::mutex mutex;
        std::unique_ptr<FrameRestorer> restorer;
        bool is_told = false;
    };
    using Unwanted = std::atomic<bool>;
    std::size_t place_of(double pulse) const;
    FrameSet decode(std::uint64_t pulse, const Unwanted& unwanted) const;
    std::shared_ptr<const RigFrame> decode(std::size_t rig, std::uint64_t pulse,
                                           const Unwanted& unwanted) const;
    /// The frame set decoded ahead, if it is of this pulse; otherwise it is discarded.
    std::optional<FrameSet> take_ahead(std::uint64_t pulse) const;
    void decode_ahead(std::uint64_t pulse) const;

    std::shared_ptr<const TakeReader> take_;
    std::vector<std::uint64_t> pulses_;  ///< of all frame sets
    std::vector<std::unique_ptr<Rig>> rigs_;

    struct Ahead {
        std::uint64_t pulse = 0;
        std::shared_ptr<Unwanted> unwanted;
        std::future<FrameSet> set;
    };
    mutable std::mutex mutex_;
    mutable std::optional<Ahead> ahead_;
    mutable std::future<FrameSet> given_up_;  ///< discarded; nothing is decoded ahead until its end
    mutable std::ptrdiff_t last_place_ = 0, last_stride_ = 0;
};

/// A feed that replaces the receiver when a take is played: its rigs, and no new frames.
StageFeed feed_of(const TakeReader& take);

}  // namespace vantage
