#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "host_app/foreground/motion/rig_motion.h"
#include "host_app/frames/past_frame_sets.h"

namespace vantage {

/// Interpolates frame sets between two pulses along the motion from one to the other. Caches the
/// last two frame sets and their motion, since slow motion requests many moments between the same
/// two. Belongs to one thread.
class InterpolatedFrameSets {
  public:
    /// Returns the frame set at `share` (above 0, below 1) of the time after `pulse`. If the next
    /// pulse has no frame set, returns that of `pulse`; a rig that is not in both keeps its frame
    /// of `pulse`. Empty if `pulse` has no frame set. Computes with one thread for each rig and
    /// waits.
    std::optional<FrameSet> at(const PastFrameSets& past, std::uint64_t pulse, double share);

  private:
    /// Returns the frame set of this pulse; null: there is none.
    const FrameSet* fetch(const PastFrameSets& past, std::uint64_t pulse);

    std::map<std::uint64_t, FrameSet> sets_;  ///< the two around the last moment, by pulse
    std::optional<std::uint64_t> motion_from_;
    std::vector<RigMotion> motions_;  ///< from motion_from_ to the next pulse, by rig
};

}  // namespace vantage
