#pragma once

#include <Eigen/Geometry>

namespace vantage {

/// Rigid motions are Eigen::Isometry3d, metres, named for what they map: world_from_camera *
/// p_camera = p_world. The world is right-handed; cameras are OpenCV's (x right, y down, z
/// forward).
using Pose = Eigen::Isometry3d;

/// world_from_camera of a camera at `eye` that looks at `target`, with the picture's up towards
/// `world_up`. Precondition: eye != target, and the viewing direction is not parallel to world_up.
Pose look_at(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m,
             const Eigen::Vector3d& world_up = Eigen::Vector3d::UnitY());

/// Between two poses at t in [0, 1]: translation linearly, rotation spherically along the shorter
/// way.
Pose interpolate(const Pose& a, const Pose& b, double t);

}  // namespace vantage
