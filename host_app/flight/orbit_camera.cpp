#include "host_app/flight/orbit_camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace vantage {
namespace {

/// Time constant with which a goal outside the corridor returns to the camera.
constexpr double forget_time_s = 0.1;

/// Step of one member of the view towards its goal: the speed falls with the remaining way and is
/// limited, and so is its rate of change.
class Follower {
  public:
    Follower(const FlightLimits& limits, double dt_s) : limits_(limits), dt_s_(dt_s) {}

    /// The step in this tick along the remaining way, a number or a vector.
    template <class Way>
    Way step(const Way& way, const Way& speed, double max_speed) const {
        Way wanted = (1 - std::exp(-dt_s_ / limits_.follow_s)) / dt_s_ * way;
        if (limits_.ramp_s <= 0) return dt_s_ * limited(wanted, max_speed);
        const double ramp = max_speed / limits_.ramp_s;
        // Half of the ramp must be enough to brake on the remaining way, so the goal is not
        // overrun.
        wanted = limited(wanted, std::min(max_speed, std::sqrt(ramp * length(way))));
        return dt_s_ * Way(speed + limited(Way(wanted - speed), ramp * dt_s_));
    }

  private:
    static double length(double way) { return std::abs(way); }
    static double length(const Eigen::Vector3d& way) { return way.norm(); }
    template <class Way>
    static Way limited(const Way& way, double max_length) {
        return length(way) > max_length ? Way(max_length / length(way) * way) : way;
    }

    const FlightLimits& limits_;
    double dt_s_;
};

}  // namespace

OrbitCamera::OrbitCamera(const OrbitView& start, const FlightLimits& limits) : limits_(limits) {
    jump_to(start);
}

void OrbitCamera::orbit(double azimuth_rad, double elevation_rad) {
    ignores_corridor_ = false;
    goal_.azimuth_rad += azimuth_rad;
    goal_.elevation_rad += elevation_rad;
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::pan(double right_widths, double up_widths) {
    ignores_corridor_ = false;
    const double width_m = 2 * goal_.distance_m * std::tan(0.5 * goal_.field_of_view_rad);
    const Eigen::Matrix3d axes = goal_.world_from_camera().linear();
    goal_.pivot_m += width_m * (right_widths * axes.col(0) - up_widths * axes.col(1));
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::crane(double up_widths) {
    ignores_corridor_ = false;
    const double width_m = 2 * goal_.distance_m * std::tan(0.5 * goal_.field_of_view_rad);
    goal_.pivot_m.y() += width_m * up_widths;
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::look(double right_rad, double up_rad) {
    ignores_corridor_ = false;
    const Eigen::Vector3d eye = goal_.eye_m();
    OrbitView turned = goal_;
    turned.azimuth_rad -= right_rad;
    turned.elevation_rad = std::clamp(goal_.elevation_rad - up_rad, -limits_.max_elevation_rad,
                                      limits_.max_elevation_rad);
    turned.pivot_m += eye - turned.eye_m();
    goal_ = taken_over(turned.camera(), limits_, turned.azimuth_rad);
}

void OrbitCamera::roll(double clockwise_rad) {
    ignores_corridor_ = false;
    goal_.roll_rad += clockwise_rad;
}

void OrbitCamera::level() {
    constexpr double turn_rad = 2 * std::numbers::pi;
    goal_.roll_rad = turn_rad * std::round(current_.roll_rad / turn_rad);
}

void OrbitCamera::carry_pivot_to(const Eigen::Vector3d& pivot_m) {
    goal_.pivot_m = pivot_m;
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::dolly(double nearer) {
    ignores_corridor_ = false;
    goal_.distance_m *= std::exp(-nearer);
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::zoom(double narrower) {
    ignores_corridor_ = false;
    goal_.field_of_view_rad *= std::exp(-narrower);
    goal_ = constrained(goal_, limits_);
}

void OrbitCamera::fly_to(const OrbitView& view) {
    goal_ = constrained(view, limits_);
    goal_.azimuth_rad = nearest_turn(goal_.azimuth_rad, current_.azimuth_rad);
    goal_.roll_rad = nearest_turn(goal_.roll_rad, current_.roll_rad);
    ignores_corridor_ = corridor_ && corridor_->of(goal_.camera()).share >= Corridor::end;
}

void OrbitCamera::jump_to(const OrbitView& view) {
    goal_ = current_ = constrained(view, limits_);
    speed_ = {};
    ignores_corridor_ = false;
}

OrbitView OrbitCamera::followed(double dt_s) const {
    OrbitView next = current_;
    const Follower follower(limits_, dt_s);
    const auto follow = [&](double OrbitView::*channel, double speed, double max_speed) {
        next.*channel += follower.step(goal_.*channel - current_.*channel, speed, max_speed);
    };
    follow(&OrbitView::azimuth_rad, speed_.azimuth, limits_.max_turn_rad_s);
    follow(&OrbitView::elevation_rad, speed_.elevation, limits_.max_turn_rad_s);
    follow(&OrbitView::roll_rad, speed_.roll, limits_.max_turn_rad_s);
    follow(&OrbitView::distance_m, speed_.distance, limits_.max_speed_m_s);
    follow(&OrbitView::field_of_view_rad, speed_.field_of_view, limits_.max_zoom_rad_s);
    next.pivot_m += follower.step(Eigen::Vector3d(goal_.pivot_m - current_.pivot_m), speed_.pivot,
                                  limits_.max_speed_m_s);
    // Both ends of the way are above the floor, but a view between them may not be.
    return constrained(next, limits_);
}

void OrbitCamera::advance(double dt_s) {
    assert(dt_s >= 0);
    if (dt_s == 0) return;
    const OrbitView before = current_, next = followed(dt_s);
    if (corridor_ && !ignores_corridor_)
        go_within_corridor(next, dt_s);
    else
        current_ = next;
    // The speed follows from the way, which limits may have shortened.
    const auto speed_of = [&](double OrbitView::*channel) {
        return (current_.*channel - before.*channel) / dt_s;
    };
    speed_ = {speed_of(&OrbitView::azimuth_rad),       speed_of(&OrbitView::elevation_rad),
              speed_of(&OrbitView::roll_rad),          speed_of(&OrbitView::distance_m),
              speed_of(&OrbitView::field_of_view_rad), (current_.pivot_m - before.pivot_m) / dt_s};
}

void OrbitCamera::go_within_corridor(const OrbitView& next, double dt_s) {
    const auto share_of = [&](const OrbitView& view) { return corridor_->of(view.camera()).share; };
    if (share_of(next) >= Corridor::edge) {
        current_ = next;
        return;
    }
    double here = share_of(current_);
    // One member of the view after another, so that only motion that leads out is held back.
    const auto go = [&](auto OrbitView::*channel) {
        using Value = std::remove_cvref_t<decltype(next.*channel)>;
        const Value way = next.*channel - current_.*channel;
        OrbitView there = current_;
        there.*channel = current_.*channel + way;
        double after = share_of(there);
        if (after < here) {
            double kept = Corridor::outward_speed(here);
            // A long step is halved until it does not cross the end.
            for (int halving = 0; halving < 6; ++halving) {
                there.*channel = current_.*channel + kept * way;
                after = share_of(there);
                if (kept == 0 || after >= std::min(here, Corridor::end)) break;
                kept = halving == 4 ? 0 : 0.5 * kept;
            }
            // The part of the goal beyond the end decays, so that input the other way acts at once.
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
    go(&OrbitView::roll_rad);
    go(&OrbitView::pivot_m);
}

}  // namespace vantage
