#pragma once

#include <Eigen/Core>

#include "host_app/views/depth_view.h"
#include "host_app/views/virtual_view.h"

namespace vantage {

// Maps between pictures with depth, as 4x4 matrices on the vector (u * z, v * z, z, 1) of the pixel
// (u, v) at depth z: the form in which a projection is linear. They are multiplied out in double,
// so that a stage far from the world's origin loses nothing in the shaders' float.

/// The virtual camera's coordinates (m) from a view's pixel with depth. `K` is the view's, or that
/// of its depth map.
Eigen::Matrix4d target_from_pixel(const VirtualView& target, const Pose& world_from_camera,
                                  const Eigen::Matrix3d& K);

/// A view's pixel with depth from the virtual view's pixel with depth.
Eigen::Matrix4d pixel_from_target_pixel(const DepthView& source, const VirtualView& target);

/// GL clip coordinates from the virtual camera's coordinates: row 0 of the picture is the first row
/// in memory, and the depth buffer holds 1 - near / z, linear in disparity, without a far plane.
Eigen::Matrix4d clip_from_target(const VirtualView& target, double near_m);

/// K of the same camera for a picture of another size.
Eigen::Matrix3d scaled_intrinsics(const Eigen::Matrix3d& K, double scale_x, double scale_y);

}  // namespace vantage
