#pragma once

#include <vector>

#include <Eigen/Core>

#include "host_app/views/depth_view.h"

namespace vantage {

/// What a view shows, in short.
struct SurfaceSamples {
    std::vector<Eigen::Vector3d> points_m;  ///< in the world
    double median_depth_m = 0;              ///< 0: the view has no depth
};

/// Known surface points of a view, evenly over its picture, at most 144.
SurfaceSamples surface_samples(const DepthView& view);

}  // namespace vantage
