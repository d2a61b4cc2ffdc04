#include "host_app/baked/probe_placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Pixels of a probe for each pixel of a rig, as far as the largest side allows.
constexpr double finer = 1.25;
constexpr int largest_side_px = 800;
/// Width of a probe's field relative to a rig's.
constexpr double wider = 1.15;
/// Share of a way along the line of sight that does not count.
constexpr double free_share = 0.8;

VirtualView probe_view(const ProbeRig& rig, const Pose& world_from_camera) {
    const double scale = std::min(finer * wider, static_cast<double>(largest_side_px) /
                                                     std::max(rig.size.width, rig.size.height));
    VirtualView view;
    view.width_px = static_cast<int>(scale * rig.size.width);
    view.height_px = static_cast<int>(scale * rig.size.height);
    view.K = scaled_intrinsics(rig.K, scale / wider, scale / wider);
    view.K(0, 2) += 0.5 * view.width_px * (1 - 1 / wider);
    view.K(1, 2) += 0.5 * view.height_px * (1 - 1 / wider);
    view.world_from_camera = world_from_camera;
    return view;
}

}  // namespace

std::vector<VirtualView> probe_views(std::span<const ProbeRig> rigs) {
    std::vector<VirtualView> views;
    const auto centre = [&](std::size_t i) { return rigs[i].world_from_camera.translation(); };
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        views.push_back(probe_view(rigs[i], rigs[i].world_from_camera));
        for (std::size_t j = i + 1; j < rigs.size(); ++j) {
            const Eigen::Vector3d middle = 0.5 * (centre(i) + centre(j));
            const double reach_m = 0.5 * (centre(i) - centre(j)).norm();
            // Two rigs are neighbours if no third one stands between them.
            bool are_neighbours = reach_m > 0;
            for (std::size_t k = 0; k < rigs.size() && are_neighbours; ++k)
                if (k != i && k != j) are_neighbours = (centre(k) - middle).norm() > reach_m;
            if (!are_neighbours) continue;
            Pose pose = Pose::Identity();
            pose.translate(middle);
            pose.rotate(Eigen::Quaterniond(rigs[i].world_from_camera.rotation())
                            .slerp(0.5, Eigen::Quaterniond(rigs[j].world_from_camera.rotation())));
            views.push_back(probe_view(rigs[i], pose));
        }
    }
    return views;
}

double largest_parallax_px_m(std::span<const VirtualView> probes) {
    // Views of a lone probe are as far from it as a person would lean.
    constexpr double least_reach_m = 0.1;
    double reach_m = least_reach_m, f_px = 0;
    for (const VirtualView& a : probes) {
        f_px = std::max(f_px, a.K(0, 0));
        double nearest_m = std::numeric_limits<double>::infinity();
        for (const VirtualView& b : probes)
            if (&a != &b)
                nearest_m = std::min(
                    nearest_m,
                    (a.world_from_camera.translation() - b.world_from_camera.translation()).norm());
        if (std::isfinite(nearest_m)) reach_m = std::max(reach_m, 0.5 * nearest_m);
    }
    return f_px * reach_m;
}

double way_m(const VirtualView& probe, const VirtualView& view) {
    const Eigen::Vector3d off =
        view.world_from_camera.translation() - probe.world_from_camera.translation();
    const Eigen::Vector3d ahead = view.world_from_camera.linear().col(2);
    return (off - free_share * off.dot(ahead) * ahead).norm();
}

}  // namespace vantage
