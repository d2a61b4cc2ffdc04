#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.h"
#include "common/image/image.h"

namespace vantage {

/// A plane of the world: the points X in metres with dot(head<3>(), X) + w() = 0.
using ScenePlane = Eigen::Vector4d;

/// A camera that stands still, and the depth of what it sees.
struct DepthMapView {
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();  ///< of the depth map
    Pose world_from_camera = Pose::Identity();
    const DepthImage* depth_m = nullptr;  ///< 0 = unknown
    double tolerance_per_m = 0;  ///< how far a point of a plane may be off it, in inverse depth
};

/// The factors of a plane's inverse depth in a camera, which is linear in the pixel: at (u, v) it
/// is the dot product with (u, v, 1), in 1/m. It is not positive where the camera does not see the
/// plane.
Eigen::RowVector3d inverse_depth_of(const ScenePlane& plane, const Eigen::Matrix3d& K,
                                    const Pose& world_from_camera);

/// The planes that cover most of what the cameras see, at most `max_planes`: floors, walls, boards.
/// First come those of the expected planes that cover at least five per cent of the points, then
/// the largest. They are proposed by small windows whose depth is plane, and chosen one
/// after the other by the number of points that are not on a chosen one yet (sequential RANSAC;
/// Fischler and Bolles, 1981, with the windows in place of random triples). A plane covers at least
/// one per cent of the points.
std::vector<ScenePlane> planes_of(std::span<const DepthMapView> views, std::size_t max_planes,
                                  std::span<const ScenePlane> expected = {});

}  // namespace vantage
