#pragma once

#include <span>
#include <vector>

#include "host_app/views/depth_view.h"
#include "host_app/views/virtual_view.h"

namespace vantage {

/// Returns the cameras of the probes for rigs with these cameras and picture sizes: one at each rig
/// and one midway between any two that are neighbours. They see a little more than the rigs do.
struct ProbeRig {
    Eigen::Matrix3d K;
    Pose world_from_camera;
    cv::Size size;
};
std::vector<VirtualView> probe_views(std::span<const ProbeRig> rigs);

/// Returns the parallax that an inverse depth of 1/m has between a probe and a view halfway to the
/// next one, px m.
double largest_parallax_px_m(std::span<const VirtualView> probes);

/// Returns how far a probe lies from a view, m. A way ahead or back counts less than one aside,
/// since it uncovers less.
double way_m(const VirtualView& probe, const VirtualView& view);

}  // namespace vantage
