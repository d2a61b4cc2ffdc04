#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.h"

namespace vantage {

/// One camera of a light field on its plane.
struct PlacedCamera {
    Eigen::Vector2d at_m = Eigen::Vector2d::Zero();  ///< on the plane
    /// How far its part reaches to the left, right, up and down: to the next row or column. 0:
    /// there is none.
    Eigen::Vector4d reach_m = Eigen::Vector4d::Zero();
};

/// The plane in which the cameras of a light field stand (Levoy and Hanrahan's uv), laid through a
/// row, a grid or a loose array of cameras that look the same way.
struct CameraPlane {
    /// x along the row, z the cameras' mean line of sight.
    Pose world_from_plane = Pose::Identity();
    std::vector<PlacedCamera> cameras;  ///< in the order they were given
    bool is_row = false;                ///< it has no height
    std::string refusal;                ///< why there is no such plane, a sentence; empty: there is
};

CameraPlane camera_plane(const std::vector<Pose>& world_from_cameras);

}  // namespace vantage
