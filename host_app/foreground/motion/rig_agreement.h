#pragma once

#include <vector>

#include "host_app/foreground/motion/rig_motion.h"

namespace vantage {

/// A rig's frames of two pulses, with the motion from one to the other.
struct FollowedRig {
    const RigFrame* first = nullptr;
    const RigFrame* second = nullptr;
    RigMotion* motion = nullptr;  ///< empty: none is known
};

/// Checks the rigs' motions for consistency. Flow and the disparities at its ends give a point's
/// motion in space, and every other rig that sees the point must see it move the same way. A region
/// where too many points are contradicted, or not followed by other rigs, is marked as not
/// followed, so that nobody is shown in two places at once. Frames without disparity take no part.
void agree_on_motion(const std::vector<FollowedRig>& rigs);

}  // namespace vantage
