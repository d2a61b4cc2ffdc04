#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host_app/synthesis/gpu_view.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// How much one view can give to a virtual view: over the view's sample points that fall into the
/// picture, the sum of 1 / (angle between the two cameras' rays at the point + a small angle). 0:
/// it sees nothing of what is wanted.
double usefulness(std::span<const Eigen::Vector3d> sample_points_m,
                  const Eigen::Vector3d& source_centre_m, const VirtualView& target);

/// The `at_most` most useful views, best first, so that the cost of a picture does not grow with
/// the stage; those of no use are left out. The pointers point into `views`.
std::vector<const GpuView*> most_useful(std::span<const std::unique_ptr<GpuView>> views,
                                        const VirtualView& target, std::size_t at_most);

/// A near plane that clips nothing one would want to see: a hundredth of the scene's typical depth.
double near_plane_m(std::span<const GpuView* const> views);

}  // namespace vantage
