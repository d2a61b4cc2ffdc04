#pragma once

#include <Eigen/Core>

#include "common/geometry/pose.h"

namespace vantage {

/// The virtual camera at one moment: six degrees of freedom and a lens. Whatever steers (a hand on
/// an orbit, keyframes, a tracked camera) ends in one of these.
struct CameraState {
    Pose world_from_camera = Pose::Identity();
    double field_of_view_rad = 0.785;  ///< horizontal
    double focus_m = 4.5;              ///< distance of what it is about: a pivot, a focal plane

    /// K of a pinhole with square pixels and its centre in the middle of the picture.
    Eigen::Matrix3d K(int width_px, int height_px) const;
};

/// Whether a picture of one would not differ visibly from one of the other.
bool is_same_view(const CameraState& a, const CameraState& b);

/// On the straight way from one to the other; 0: `a`, 1: `b`.
CameraState mixed(const CameraState& a, const CameraState& b, double share_of_b);

}  // namespace vantage
