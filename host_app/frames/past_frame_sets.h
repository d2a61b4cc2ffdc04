#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/receive/frame_set.h"

namespace vantage {

/// Random access to past frame sets by pulse: those of the replay buffer, or of a take.
/// Thread-safe.
class PastFrameSets {
  public:
    virtual ~PastFrameSets() = default;

    /// Pulse of the newest frame set not later than `pulse`, otherwise of the oldest; empty if
    /// there is none.
    virtual std::optional<std::uint64_t> pulse_at(double pulse) const = 0;
    /// Decodes and returns that frame set.
    virtual std::optional<FrameSet> at(double pulse) const = 0;

    struct Span {
        std::uint64_t oldest = 0, newest = 0;  ///< pulses
        std::size_t sets = 0, bytes = 0;       ///< number and size of the frame sets
    };
    /// Empty if there is no frame set.
    virtual std::optional<Span> span() const = 0;
};

}  // namespace vantage
