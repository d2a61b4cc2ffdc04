#pragma once

#include "common/geometry/pose.h"

namespace vantage {

/// Which way a camera looks, as operators say it: about the stage's vertical, to the right; up;
/// clockwise as seen from behind it.
struct PanTiltRoll {
    double pan_rad = 0, tilt_rad = 0, roll_rad = 0;
};
/// Pan 0 looks along the stage's -z. Of a camera that looks straight up or down, where pan and roll
/// are one turn, it is pan.
PanTiltRoll pan_tilt_roll_of(const Pose& world_from_camera);
/// The rotation that looks so.
Eigen::Matrix3d turned(const PanTiltRoll& turn);

}  // namespace vantage
