#pragma once

#include "common/geometry/pose.h"

namespace vantage {

/// The virtual camera: a pinhole camera with any intrinsics.
struct VirtualView {
    int width_px = 0, height_px = 0;
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    Pose world_from_camera = Pose::Identity();
};

}  // namespace vantage
