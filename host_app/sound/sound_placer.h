#pragma once

#include <span>

#include "common/av/sound.h"

namespace vantage {

/// Assigns times to the blocks of a device. A device has a clock of its own: blocks are shortened
/// or lengthened by a sample now and then to follow the computer's clock, inaudibly. Not
/// thread-safe.
class SoundPlacer {
  public:
    /// Places the next block, whose last sample was heard at about `heard_until`. Empty: the block
    /// came far too early and is dropped.
    SoundBlock place(std::span<const float> block, TaiTime heard_until);

    struct Stats {
        std::uint64_t heard = 0, lost = 0, dropped = 0, inserted = 0, removed = 0;
        /// How fast the device's clock is relative to this computer's.
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
    double late_ = 0;  ///< average lateness of blocks in samples, over some seconds
    Stats stats_;
};

}  // namespace vantage
