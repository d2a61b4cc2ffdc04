#include "host_app/flight/orbit_view.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "common/geometry/axis_crossing.h"

namespace vantage {

PanTiltRoll pan_tilt_roll_of(const Pose& world_from_camera) {
    const Eigen::Vector3d right = world_from_camera.linear().col(0);
    const Eigen::Vector3d forward = world_from_camera.linear().col(2);
    constexpr double min_level = 1e-7;
    const bool has_direction = std::hypot(forward.x(), forward.z()) > min_level;
    PanTiltRoll turn;
    turn.pan_rad =
        has_direction ? std::atan2(forward.x(), -forward.z()) : std::atan2(right.z(), right.x());
    turn.tilt_rad = std::asin(std::clamp(forward.y(), -1.0, 1.0));
    const Eigen::Vector3d level(std::cos(turn.pan_rad), 0, std::sin(turn.pan_rad));
    turn.roll_rad = std::atan2(-right.dot(level.cross(forward)), right.dot(level));
    return turn;
}

Eigen::Matrix3d turned(const PanTiltRoll& turn) {
    const Eigen::Vector3d forward(std::sin(turn.pan_rad) * std::cos(turn.tilt_rad),
                                  std::sin(turn.tilt_rad),
                                  -std::cos(turn.pan_rad) * std::cos(turn.tilt_rad));
    const Eigen::Vector3d level(std::cos(turn.pan_rad), 0, std::sin(turn.pan_rad));
    const Eigen::Vector3d right =
        std::cos(turn.roll_rad) * level - std::sin(turn.roll_rad) * level.cross(forward);
    Eigen::Matrix3d rotation;
    rotation << right, forward.cross(right), forward;
    return rotation;
}

Eigen::Vector3d OrbitView::eye_m() const {
    const double horizontal = std::cos(elevation_rad);
    return pivot_m + distance_m * Eigen::Vector3d(horizontal * std::sin(azimuth_rad),
                                                  std::sin(elevation_rad),
                                                  horizontal * std::cos(azimuth_rad));
}

Pose OrbitView::world_from_camera() const {
    Pose pose = Pose::Identity();
    pose.linear() = turned({-azimuth_rad, -elevation_rad, roll_rad});
    pose.translation() = eye_m();
    return pose;
}

OrbitView view_from_eye(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m,
                        double field_of_view_rad, double near_azimuth_rad) {
    const Eigen::Vector3d arm = eye_m - target_m;
    assert(arm.norm() > 0);
    OrbitView view;
    view.pivot_m = target_m;
    view.distance_m = arm.norm();
    view.elevation_rad = std::asin(std::clamp(arm.y() / arm.norm(), -1.0, 1.0));
    view.azimuth_rad = nearest_turn(std::atan2(arm.x(), arm.z()), near_azimuth_rad);
    view.field_of_view_rad = field_of_view_rad;
    return view;
}

OrbitView orbit_view_of(const CameraState& camera, double near_azimuth_rad) {
    const PanTiltRoll turn = pan_tilt_roll_of(camera.world_from_camera);
    OrbitView view;
    view.distance_m = camera.focus_m;
    view.azimuth_rad = nearest_turn(-turn.pan_rad, near_azimuth_rad);
    view.elevation_rad = -turn.tilt_rad;
    view.roll_rad = turn.roll_rad;
    view.field_of_view_rad = camera.field_of_view_rad;
    view.pivot_m = camera.world_from_camera * Eigen::Vector3d(0, 0, camera.focus_m);
    return view;
}

double nearest_turn(double angle_rad, double near_rad) {
    return near_rad + std::remainder(angle_rad - near_rad, 2 * std::numbers::pi);
}

OrbitView constrained(OrbitView view, const FlightLimits& limits) {
    const double reach = limits.max_pivot_offset_m;
    view.pivot_m.x() = std::clamp(view.pivot_m.x(), -reach, reach);
    view.pivot_m.y() = std::clamp(view.pivot_m.y(), limits.min_eye_height_m, reach);
    view.pivot_m.z() = std::clamp(view.pivot_m.z(), -reach, reach);
    view.distance_m = std::clamp(view.distance_m, limits.min_distance_m, limits.max_distance_m);
    view.field_of_view_rad = std::clamp(view.field_of_view_rad, limits.min_field_of_view_rad,
                                        limits.max_field_of_view_rad);
    // The pivot is above the floor's margin, so the sine is at most 0.
    const double floor_sine =
        std::max((limits.min_eye_height_m - view.pivot_m.y()) / view.distance_m, -1.0);
    const double lowest = std::max(std::asin(floor_sine), -limits.max_elevation_rad);
    view.elevation_rad = std::clamp(view.elevation_rad, lowest, limits.max_elevation_rad);
    return view;
}

OrbitView taken_over(const CameraState& camera, const FlightLimits& limits,
                     double near_azimuth_rad) {
    const Eigen::Vector3d eye = camera.world_from_camera.translation();
    const Eigen::Vector3d forward = camera.world_from_camera.linear().col(2);
    CameraState near = camera;
    near.focus_m = std::clamp(camera.focus_m, limits.min_distance_m, limits.max_distance_m);
    const auto keep_within = [&](int axis, double least, double most) {
        const double way_m = (forward[axis] < 0 ? least : most) - eye[axis];
        if (forward[axis] != 0) near.focus_m = std::min(near.focus_m, way_m / forward[axis]);
    };
    keep_within(0, -limits.max_pivot_offset_m, limits.max_pivot_offset_m);
    keep_within(1, limits.min_eye_height_m, limits.max_pivot_offset_m);
    keep_within(2, -limits.max_pivot_offset_m, limits.max_pivot_offset_m);
    near.focus_m = std::max(near.focus_m, limits.min_distance_m);
    return constrained(orbit_view_of(near, near_azimuth_rad), limits);
}

bool is_same_shot(const OrbitView& a, const OrbitView& b) {
    constexpr double same = 1e-6;
    const auto is_same_angle = [&](double one, double other) {
        return std::abs(nearest_turn(one, other) - other) < same;
    };
    return (a.pivot_m - b.pivot_m).norm() < same && is_same_angle(a.azimuth_rad, b.azimuth_rad) &&
           is_same_angle(a.roll_rad, b.roll_rad) &&
           std::abs(a.elevation_rad - b.elevation_rad) < same &&
           std::abs(a.distance_m - b.distance_m) < same &&
           std::abs(a.field_of_view_rad - b.field_of_view_rad) < same;
}

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
