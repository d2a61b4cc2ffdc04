#pragma once

#include <Eigen/Core>

#include "host_app/views/depth_view.h"

namespace vantage {

// Projections between pictures with depth, as 4x4 matrices on the vector (u * z, v * z, z, 1) of
// the pixel (u, v) at depth z, in which they are linear. They are multiplied in double precision,
// so that a stage far from the world's origin loses nothing in the float arithmetic of the shaders.

/// Maps a view's pixel with depth to the virtual camera's coordinates (m). `K` belongs to the
/// view's picture or to its depth map.
Eigen::Matrix4d target_from_pixel(const VirtualView& target, const Pose& world_from_camera,
                                  const Eigen::Matrix3d& K);

/// Maps a pixel with depth of the virtual view to a pixel with depth of a view.
Eigen::Matrix4d pixel_from_target_pixel(const DepthView& source, const VirtualView& target);

/// Maps the virtual camera's coordinates to GL clip coordinates. Row 0 of the picture is the first
/// row in memory; the depth buffer holds 1 - near / z, linear in disparity, without a far plane.
Eigen::Matrix4d clip_from_target(const VirtualView& target, double near_m);

/// The parallax of a pixel at a depth, under such a map: the derivative of its place in the other
/// picture by the logarithm of its inverse depth, px. 0 if depth_m is not above 0.
double parallax_px(const Eigen::Matrix4d& map, const Eigen::Vector2d& pixel, double depth_m);

/// K of the same camera for a picture of another size.
Eigen::Matrix3d scaled_intrinsics(const Eigen::Matrix3d& K, double scale_x, double scale_y);

}  // namespace vantage
