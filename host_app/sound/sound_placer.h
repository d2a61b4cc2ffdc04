#pragma once

#include <span>

#include "common/av/sound.h"

namespace vantage {

/// Gives what a device delivers its place in time. A device counts by a clock of its own: where
/// that is ahead or behind, a block is a sample shorter or longer now and then, which nobody hears.
class SoundPlacer {
  public:
    /// The block comes next, and its last sample was heard at `heard_until`, give or take what the
    /// system needed to say so. Empty: it came far too early, and is dropped.
    SoundBlock place(std::span<const float> block, TaiTime heard_until);

    struct Stats {
        std::uint64_t heard = 0, lost = 0, dropped = 0, inserted = 0, removed = 0;
        /// Of the device's clock, ahead of this computer's.
        double drift_ppm() const {
            return heard == 0
                       ? 0
                       : 1e6 * (static_cast<double>(removed) - static_cast<double>(inserted)) /
                             static_cast<double>(heard);
        }
    };
    const Stats& stats() const { return stats_; }

  private:
    std::optional<std::int64_t> next_;
    double late_ = 0;  ///< by how many samples blocks come after their place, over some seconds
    Stats stats_;
};

}  // namespace vantage
