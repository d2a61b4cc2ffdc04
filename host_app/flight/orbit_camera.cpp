#include "host_app/flight/orbit_camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vantage {
namespace {

/// Time in which the camera covers 63 % of the way to its goal.
constexpr double follow_time_s = 0.12;

/// The part of `way` that is covered in this step.
double covered(double way, double share, double most) {
    return std::clamp(way * share, -most, most);
}

}  // namespace

OrbitCamera::OrbitCamera(const OrbitView& start, const FlightLimits& limits) : limits_(limits) {
    jump_to(start);
}

void OrbitCamera::orbit(double azimuth_rad, double elevation_rad) {
    goal_.azimuth_rad += azimuth_rad;
    goal_.elevation_rad += elevation_rad;
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::pan(double right_widths, double up_widths) {
    const double width_m = 2 * goal_.distance_m * std::tan(0.5 * goal_.field_of_view_rad);
    const Eigen::Matrix3d axes = goal_.world_from_camera().linear();
    goal_.pivot_m += width_m * (right_widths * axes.col(0) - up_widths * axes.col(1));
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::dolly(double nearer) {
    goal_.distance_m *= std::exp(-nearer);
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::zoom(double narrower) {
    goal_.field_of_view_rad *= std::exp(-narrower);
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::fly_to(const OrbitView& view) {
    goal_ = constrained(view, limits_);
    goal_.azimuth_rad = nearest_turn(goal_.azimuth_rad, current_.azimuth_rad);
}

void OrbitCamera::jump_to(const OrbitView& view) { goal_ = current_ = constrained(view, limits_); }

void OrbitCamera::advance(double dt_s) {
    assert(dt_s >= 0);
    const double share = 1 - std::exp(-dt_s / follow_time_s);
    const double most_turn = limits_.max_turn_rad_s * dt_s;
    const double most_way = limits_.max_speed_m_s * dt_s;
    current_.azimuth_rad += covered(goal_.azimuth_rad - current_.azimuth_rad, share, most_turn);
    current_.elevation_rad +=
        covered(goal_.elevation_rad - current_.elevation_rad, share, most_turn);
    current_.distance_m += covered(goal_.distance_m - current_.distance_m, share, most_way);
    current_.field_of_view_rad += covered(goal_.field_of_view_rad - current_.field_of_view_rad,
                                          share, limits_.max_zoom_rad_s * dt_s);
    Eigen::Vector3d step = share * (goal_.pivot_m - current_.pivot_m);
    if (step.norm() > most_way) step *= most_way / step.norm();
    current_.pivot_m += step;
    // Both ends of the way are above the floor, but not every mixture of them.
    current_ = constrained(current_, limits_);
}

}  // namespace vantage
