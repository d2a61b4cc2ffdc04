#pragma once

#include "host_app/foreground/motion/rig_motion.h"

namespace vantage {

/// Interpolates the rig's frame at `share` (0..1) of the time from `first` to `second`. Colour and
/// disparity move along the motion; nearer surfaces hide farther ones, and a pixel belongs to a
/// surface that covers half of it. Pixels that no surface moves to show the farther surface of the
/// two frames, since the background stands still. Where motion is not followed, the result is the
/// frame that is nearer in time. Precondition: the motion is that of the two frames and not empty.
RigFrame frame_between(const RigFrame& first, const RigFrame& second, const RigMotion& motion,
                       double share);

}  // namespace vantage
