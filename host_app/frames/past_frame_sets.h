#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/receive/frame_set.h"

namespace vantage {

/// Frame sets of the past by their pulse: of the replay buffer, or of a take. Safe to use from any
/// thread.
class PastFrameSets {
  public:
    virtual ~PastFrameSets() = default;

    /// Of the newest set that is not later than `pulse`, else of the oldest there is; empty if none
    /// is.
    virtual std::optional<std::uint64_t> pulse_at(double pulse) const = 0;
    /// That set. Decodes it.
    virtual std::optional<FrameSet> at(double pulse) const = 0;

    struct Span {
        std::uint64_t oldest = 0, newest = 0;  ///< pulses
        std::size_t sets = 0, bytes = 0;
    };
    /// Empty if nothing is kept.
    virtual std::optional<Span> span() const = 0;
};

}  // namespace vantage
