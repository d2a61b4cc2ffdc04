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

/// The frame sets of a take, decoded a rig a thread. While it goes in even steps the next set is
/// decoded before it is asked for; after a jump the set that was asked for comes first and alone.
/// A frame that is damaged is absent from its set, and told of once in the log.
class TakeFrameSets final : public PastFrameSets {
  public:
    /// Throws Error if the take holds no frame.
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
    /// What was decoded ahead, if it is of this pulse; else that is given up.
    std::optional<FrameSet> take_ahead(std::uint64_t pulse) const;
    void decode_ahead(std::uint64_t pulse) const;

    std::shared_ptr<const TakeReader> take_;
    std::vector<std::uint64_t> pulses_;  ///< of which there are sets
    std::vector<std::unique_ptr<Rig>> rigs_;

    struct Ahead {
        std::uint64_t pulse = 0;
        std::shared_ptr<Unwanted> unwanted;
        std::future<FrameSet> set;
    };
    mutable std::mutex mutex_;
    mutable std::optional<Ahead> ahead_;
    mutable std::future<FrameSet> given_up_;  ///< nothing is decoded ahead until it is done
    mutable std::ptrdiff_t last_place_ = 0, last_stride_ = 0;
};

/// What stands for the receiver where a take is played: its rigs, and nothing that arrives.
StageFeed feed_of(const TakeReader& take);

}  // namespace vantage
