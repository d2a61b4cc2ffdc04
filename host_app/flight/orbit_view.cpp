#include "host_app/flight/orbit_view.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace vantage {

Eigen::Vector3d OrbitView::eye_m() const {
    const double horizontal = std::cos(elevation_rad);
    return pivot_m + distance_m * Eigen::Vector3d(horizontal * std::sin(azimuth_rad),
                                                  std::sin(elevation_rad),
                                                  horizontal * std::cos(azimuth_rad));
}

Pose OrbitView::world_from_camera() const { return look_at(eye_m(), pivot_m); }

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

}  // namespace vantage
