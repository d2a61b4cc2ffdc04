#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "host_app/foreground/motion/rig_motion.h"
#include "host_app/frames/past_frame_sets.h"

namespace vantage {

/// Frame sets of moments between two pulses, made of what moved from one to the other. Keeps the
/// two sets that it looked at last with their motion, since slow motion asks for many moments
/// between the same two. Belongs to one thread.
class InterpolatedFrameSets {
  public:
    /// `share`: above 0, below 1. The set of `pulse` itself where the next pulse has none, and of a
    /// rig its frame of `pulse` where it is not in both. Empty if there is no set of `pulse`. Works
    /// a rig a thread, and waits.
    std::optional<FrameSet> at(const PastFrameSets& past, std::uint64_t pulse, double share);

  private:
    /// Null: there is no set of this pulse.
    const FrameSet* fetch(const PastFrameSets& past, std::uint64_t pulse);

    std::map<std::uint64_t, FrameSet> sets_;  ///< by pulse: the two around the last moment
    std::optional<std::uint64_t> motion_from_;
    std::vector<RigMotion> motions_;  ///< from the set of motion_from_ to the next, a rig each
};

}  // namespace vantage
