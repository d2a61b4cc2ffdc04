#include "host_app/flight/stage_framing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "common/geometry/axis_crossing.h"

namespace vantage {
namespace {

/// Smallest ratio of singular values at which the crossing of the axes counts as known; below it
/// they are nearly parallel.
constexpr double min_crossing = 0.01;
/// Nearest and farthest distance to the pivot, and the range of the pivot, as shares of the depth.
constexpr double nearest = 0.05, farthest = 6, reach = 4;
/// Distances of performers and of the background from the middle, as shares of the depth.
constexpr double performers = 0.4, background = 0.8;
constexpr double floor_margin_m = 0.05, same_place_m = 0.01;

/// The crossing of all rigs' optical axes; nothing if they are nearly parallel.
std::optional<Eigen::Vector3d> crossing(std::span<const FramedRig> rigs) {
    AxisCrossing axes;
    for (const FramedRig& rig : rigs) axes.add(rig.world_from_camera);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes.sum());
    if (svd.singularValues()[2] < min_crossing * svd.singularValues()[0]) return std::nullopt;
    return axes.point();
}

}  // namespace

std::optional<StageFraming> frame_stage(std::span<const FramedRig> all) {
    std::vector<FramedRig> rigs;
    for (const FramedRig& rig : all)
        if (rig.median_depth_m > 0) rigs.push_back(rig);
    if (rigs.empty()) return std::nullopt;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double lowest_m = 0, depth_m = 0;
    for (const FramedRig& rig : rigs) {
        const Eigen::Vector3d& at = rig.world_from_camera.translation();
        mean += at / static_cast<double>(rigs.size());
        lowest_m = std::min(lowest_m, at.y() - rig.median_depth_m);
        depth_m = std::max(depth_m, rig.median_depth_m);
    }
    const FramedRig* nearest_rig = &rigs.front();
    const auto off_m = [&](const FramedRig& rig) {
        return (rig.world_from_camera.translation() - mean).norm();
    };
    // Of two rigs at the same distance the first counts.
    for (const FramedRig& rig : rigs)
        if (off_m(rig) < off_m(*nearest_rig) - same_place_m) nearest_rig = &rig;
    const FramedRig& middle = *nearest_rig;
    const Eigen::Vector3d eye = middle.world_from_camera.translation();
    const Eigen::Vector3d axis = middle.world_from_camera.linear().col(2);
    Eigen::Vector3d pivot = eye + middle.median_depth_m * axis;
    if (const std::optional<Eigen::Vector3d> meeting = crossing(rigs)) {
        // The crossing is the pivot only if it lies at about the depth that this rig sees.
        const double along_m = axis.dot(*meeting - eye);
        if (along_m > 0.3 * middle.median_depth_m && along_m < 3 * middle.median_depth_m)
            pivot = eye + along_m * axis;
    }
    StageFraming framing;
    framing.start = view_from_eye(eye, pivot, middle.field_of_view_rad);
    FlightLimits& limits = framing.limits;
    // If a rig stands below y = 0, the floor is below everything that the rigs see.
    const bool has_floor = std::all_of(rigs.begin(), rigs.end(), [](const FramedRig& rig) {
        return rig.world_from_camera.translation().y() > floor_margin_m;
    });
    limits.min_eye_height_m = has_floor ? floor_margin_m : lowest_m;
    limits.min_distance_m = nearest * depth_m;
    limits.max_distance_m = std::max(farthest * depth_m, framing.start.distance_m);
    limits.max_pivot_offset_m = mean.cwiseAbs().maxCoeff() + reach * depth_m;
    limits.max_speed_m_s = std::max(depth_m, 0.1);
    framing.extent = {pivot, performers * depth_m, background * depth_m};
    return framing;
}

}  // namespace vantage
