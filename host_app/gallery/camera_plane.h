#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.h"

namespace vantage {

/// One camera of a light field on its plane.
struct PlacedCamera {
    Eigen::Vector2d at_m = Eigen::Vector2d::Zero();  ///< on the plane
    /// Distance to the next column or row on the left, right, top and bottom. 0: there is none.
    Eigen::Vector4d reach_m = Eigen::Vector4d::Zero();
};

/// The plane that the cameras of a light field lie in (Levoy and Hanrahan's uv plane), fitted to a
/// row, a grid or a loose array of cameras that face the same way.
struct CameraPlane {
    /// x points along the row, z along the cameras' mean line of sight.
    Pose world_from_plane = Pose::Identity();
    std::vector<PlacedCamera> cameras;  ///< in the order they were given
    bool is_row = false;                ///< the cameras form a row and no grid
    std::string refusal;  ///< a sentence that says why there is no plane; empty if there is one
};

CameraPlane camera_plane(const std::vector<Pose>& world_from_cameras);

}  // namespace vantage
