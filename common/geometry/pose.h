#pragma once

#include <Eigen/Geometry>

namespace vantage {

/// A rigid transform in metres, named for the frames that it maps between: world_from_camera *
/// p_camera = p_world. The world is right-handed; cameras have x right, y down, z forward, as in
/// OpenCV.
using Pose = Eigen::Isometry3d;

/// world_from_camera of a camera at `eye` looking at `target`, with the image's up towards
/// `world_up`. Precondition: eye != target, and the viewing direction is not parallel to world_up.
Pose look_at(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m,
             const Eigen::Vector3d& world_up = Eigen::Vector3d::UnitY());

/// Interpolates two poses at t in [0, 1]: translation linearly, rotation spherically on the shorter
/// arc.
Pose interpolate(const Pose& a, const Pose& b, double t);

}  // namespace vantage
