#include "host_app/flight/orbit_camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>

namespace vantage {
namespace {

/// Time in which the camera covers 63 % of the way to its goal.
constexpr double follow_time_s = 0.12;
/// Time in which a goal beyond the end of the corridor comes back to the camera by 63 %.
constexpr double forget_time_s = 0.1;

/// The part of `way` that is covered in this step.
double covered(double way, double share, double most) {
    return std::clamp(way * share, -most, most);
}

}  // namespace

OrbitCamera::OrbitCamera(const OrbitView& start, const FlightLimits& limits) : limits_(limits) {
    jump_to(start);
}

void OrbitCamera::orbit(double azimuth_rad, double elevation_rad) {
    is_let_through_ = false;
    goal_.azimuth_rad += azimuth_rad;
    goal_.elevation_rad += elevation_rad;
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::pan(double right_widths, double up_widths) {
    is_let_through_ = false;
    const double width_m = 2 * goal_.distance_m * std::tan(0.5 * goal_.field_of_view_rad);
    const Eigen::Matrix3d axes = goal_.world_from_camera().linear();
    goal_.pivot_m += width_m * (right_widths * axes.col(0) - up_widths * axes.col(1));
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::dolly(double nearer) {
    is_let_through_ = false;
    goal_.distance_m *= std::exp(-nearer);
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::zoom(double narrower) {
    is_let_through_ = false;
    goal_.field_of_view_rad *= std::exp(-narrower);
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::fly_to(const OrbitView& view) {
    goal_ = constrained(view, limits_);
    goal_.azimuth_rad = nearest_turn(goal_.azimuth_rad, current_.azimuth_rad);
    is_let_through_ = corridor_ && corridor_->of(goal_.camera()).share >= Corridor::end;
}

void OrbitCamera::jump_to(const OrbitView& view) {
    goal_ = current_ = constrained(view, limits_);
    is_let_through_ = false;
}

OrbitView OrbitCamera::followed(double dt_s) const {
    OrbitView next = current_;
    const double share = 1 - std::exp(-dt_s / follow_time_s);
    const double most_turn = limits_.max_turn_rad_s * dt_s;
    const double most_way = limits_.max_speed_m_s * dt_s;
    next.azimuth_rad += covered(goal_.azimuth_rad - next.azimuth_rad, share, most_turn);
    next.elevation_rad += covered(goal_.elevation_rad - next.elevation_rad, share, most_turn);
    next.distance_m += covered(goal_.distance_m - next.distance_m, share, most_way);
    next.field_of_view_rad += covered(goal_.field_of_view_rad - next.field_of_view_rad, share,
                                      limits_.max_zoom_rad_s * dt_s);
    Eigen::Vector3d step = share * (goal_.pivot_m - next.pivot_m);
    if (step.norm() > most_way) step *= most_way / step.norm();
    next.pivot_m += step;
    // Both ends of the way are above the floor, but not every mixture of them.
    return constrained(next, limits_);
}

void OrbitCamera::advance(double dt_s) {
    assert(dt_s >= 0);
    const OrbitView next = followed(dt_s);
    if (corridor_ && !is_let_through_)
        go_within_corridor(next, dt_s);
    else
        current_ = next;
}

void OrbitCamera::go_within_corridor(const OrbitView& next, double dt_s) {
    const auto share_of = [&](const OrbitView& view) { return corridor_->of(view.camera()).share; };
    if (share_of(next) >= Corridor::edge) {
        current_ = next;
        return;
    }
    double here = share_of(current_);
    // One way of moving after another, so that only what leads out is held back.
    const auto go = [&](auto OrbitView::*channel) {
        using Value = std::remove_cvref_t<decltype(next.*channel)>;
        const Value way = next.*channel - current_.*channel;
        OrbitView there = current_;
        there.*channel = current_.*channel + way;
        double after = share_of(there);
        if (after < here) {
            double kept = Corridor::outward_speed(here);
            // However long this step: not across the end.
            for (int halving = 0; halving < 6; ++halving) {
                there.*channel = current_.*channel + kept * way;
                after = share_of(there);
                if (kept == 0 || after >= std::min(here, Corridor::end)) break;
                kept = halving == 4 ? 0 : 0.5 * kept;
            }
            // What a hand asks for beyond the end is forgotten, so that the way back is felt at
            // once.
            const double remembered = std::exp(-(1 - kept) * dt_s / forget_time_s);
            goal_.*channel = there.*channel + remembered * (goal_.*channel - there.*channel);
        }
        current_ = constrained(there, limits_);
        here = after;
    };
    go(&OrbitView::azimuth_rad);
    go(&OrbitView::elevation_rad);
    go(&OrbitView::distance_m);
    go(&OrbitView::field_of_view_rad);
    go(&OrbitView::pivot_m);
}

}  // namespace vantage
