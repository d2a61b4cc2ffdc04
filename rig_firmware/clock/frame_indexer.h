#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/time/pulse_grid.h"

namespace vantage {

/// Says which pulse exposed a frame, by time and never by arrival: the pulse that was sent (or
/// seen on the wire) one time stamp delay before the frame's stamp, within a quarter of a period.
/// A frame without such a pulse, and a second one for the same pulse, are unsynchronized.
class FrameIndexer {
  public:
    FrameIndexer(const PulseGrid& grid, std::chrono::nanoseconds timestamp_delay)
        : grid_(grid), delay_(timestamp_delay) {}

    /// A pulse of this rig's own: its index is known.
    void sent(std::uint64_t index);
    /// The leading edge of another rig's pulse. An edge farther than a quarter of a period from the
    /// grid belongs to no pulse of the stage; returns whether it belongs to one.
    bool seen(TaiTime edge);

    /// The pulses before the clock was set have other indices than those after it: the pulses that
    /// it leapt over were not missed.
    void clock_was_set();

    /// The pulse of the frame with this time stamp; empty: unsynchronized.
    std::optional<std::uint64_t> index_of(TaiTime stamp);

    std::uint64_t pulses() const { return pulse_count_; }  ///< sent or seen so far
    std::uint64_t unsynchronized() const { return unsynchronized_; }
    std::uint64_t duplicates() const { return duplicates_; }
    std::uint64_t stray_edges() const { return stray_edges_; }
    /// Pulses of the stage between two edges that were seen, without one of their own.
    std::uint64_t missing_edges() const { return missing_edges_; }
    /// Pulses of the stage since the first frame for which no frame came, or that were not sent.
    std::uint64_t missed() const { return missed_; }

  private:
    PulseGrid grid_;
    std::chrono::nanoseconds delay_;
    std::deque<std::uint64_t> pulses_;
    std::optional<std::uint64_t> last_;  ///< given to a frame
    std::uint64_t pulse_count_ = 0;
    std::uint64_t unsynchronized_ = 0, duplicates_ = 0, stray_edges_ = 0, missing_edges_ = 0,
                  missed_ = 0;
};

}  // namespace vantage
