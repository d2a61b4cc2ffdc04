#pragma once

#include <vector>

#include <Eigen/Core>

#include "host_app/views/depth_view.h"

namespace vantage {

/// A few surface points of a view, as a summary of the places that it sees.
struct SurfaceSamples {
    std::vector<Eigen::Vector3d> points_m;  ///< in world coordinates
    double median_depth_m = 0;              ///< 0 if the view has no depth
};

/// Samples at most 144 surface points of a view, evenly over its picture.
SurfaceSamples surface_samples(const DepthView& view);

}  // namespace vantage
