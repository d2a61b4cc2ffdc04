#pragma once

#include <vector>

#include "host_app/foreground/motion/rig_motion.h"

namespace vantage {

/// A rig's frames of two pulses, and what moved from one to the other.
struct FollowedRig {
    const RigFrame* first = nullptr;
    const RigFrame* second = nullptr;
    RigMotion* motion = nullptr;  ///< empty: says nothing
};

/// Has rigs ask each other what they follow: by flow and by the disparities at its ends a point
/// goes from one place in space to another, and every other rig that sees the first has to see it
/// go that way. A region of which too many points are contradicted, or not followed elsewhere, is
/// left alone in this rig too, so that nobody is in two places at once. Frames without disparity
/// neither ask nor answer.
void agree_on_motion(const std::vector<FollowedRig>& rigs);

}  // namespace vantage
