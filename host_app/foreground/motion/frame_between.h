#pragma once

#include "host_app/foreground/motion/rig_motion.h"

namespace vantage {

/// What the rig would have seen at `share` (0..1) of the time from `first` to `second`: colour and
/// disparity go along the motion, the nearest surface before others, and a pixel is of a surface
/// that covers half of it. Where none ends is what the farther one of both frames shows there: a
/// set stands still behind those who move. Where motion is not followed all is as in the frame that
/// is nearer in time. Precondition: the motion is theirs, and not empty.
RigFrame frame_between(const RigFrame& first, const RigFrame& second, const RigMotion& motion,
                       double share);

}  // namespace vantage
