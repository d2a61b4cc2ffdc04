#include "host_app/flight/helm.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace vantage {
namespace {

constexpr double rad_per_step = std::numbers::pi / 180;
constexpr double rad_per_shuttle_s = 30 * std::numbers::pi / 180;
constexpr double move_s_per_step = 0.1;
/// Time in which a wheel's step is travelled by 63 %.
constexpr double wheel_follow_s = 0.08;
constexpr double join_s = 0.8;

OrbitView mixed(const OrbitView& a, OrbitView b, double share_of_b) {
    b.azimuth_rad = nearest_turn(b.azimuth_rad, a.azimuth_rad);
    const auto mix = [&](double from, double to) { return from + share_of_b * (to - from); };
    OrbitView view;
    view.pivot_m = a.pivot_m + share_of_b * (b.pivot_m - a.pivot_m);
    view.azimuth_rad = mix(a.azimuth_rad, b.azimuth_rad);
    view.elevation_rad = mix(a.elevation_rad, b.elevation_rad);
    view.distance_m = mix(a.distance_m, b.distance_m);
    view.field_of_view_rad = mix(a.field_of_view_rad, b.field_of_view_rad);
    return view;
}

}  // namespace

const char* name_of(WheelMode mode) {
    switch (mode) {
        case WheelMode::orbit:
            return "orbit";
        case WheelMode::move:
            return "move";
        case WheelMode::past:
            break;
    }
    return "past";
}

Helm::Helm(const OrbitView& start, std::optional<Move> move, bool has_past)
    : camera_(start), start_(start), has_past_(has_past), move_(std::move(move)) {
    if (!move_) return;
    on_move_ = playing_ = true;
    mode_ = WheelMode::move;
}

void Helm::settle(const FlightLimits& limits, const std::optional<OrbitView>& start) {
    limits_ = limits;
    if (start) start_ = *start;
    camera_ = OrbitCamera(start ? *start : camera_.view(), limits);
    camera_.keep_within(corridor_);
}

void Helm::stand_at(const OrbitView& view) {
    leave_move();
    camera_.jump_to(constrained(view, limits_));
}

OrbitView Helm::view() const {
    if (!on_move_) return camera_.view();
    OrbitView on_move = move_->at(move_s_);
    if (joining_ <= 0) return on_move;
    const double gone = 1 - joining_;
    return constrained(mixed(joined_from_, on_move, gone * gone * (3 - 2 * gone)), limits_);
}

std::optional<double> Helm::move_progress() const {
    if (!on_move_) return std::nullopt;
    const double turns = move_s_ / move_->duration_s();
    return move_->loops() ? turns - std::floor(turns) : std::clamp(turns, 0.0, 1.0);
}

void Helm::leave_move() {
    if (!on_move_) return;
    camera_.jump_to(view());
    on_move_ = playing_ = false;
    pending_s_ = joining_ = 0;
}

void Helm::join_move() {
    playing_ = false;
    if (on_move_) return;
    joined_from_ = camera_.view();
    joining_ = 1;
    on_move_ = true;
}

void Helm::travel(double seconds) {
    move_s_ += seconds;
    if (!move_->loops()) move_s_ = std::clamp(move_s_, 0.0, move_->duration_s());
}

void Helm::next_mode() {
    switch (mode_) {
        case WheelMode::orbit:
            if (move_)
                mode_ = WheelMode::move;
            else if (has_past_)
                mode_ = WheelMode::past;
            break;
        case WheelMode::move:
            mode_ = has_past_ ? WheelMode::past : WheelMode::orbit;
            break;
        case WheelMode::past:
            mode_ = WheelMode::orbit;
            break;
    }
}

void Helm::take_wheel(const FlightInput& input) {
    if (mode_ == WheelMode::past) return;
    if (mode_ == WheelMode::orbit) {
        leave_move();
        camera_.orbit(input.wheel_steps * rad_per_step + input.shuttle_s * rad_per_shuttle_s, 0);
        return;
    }
    join_move();
    pending_s_ += input.wheel_steps * move_s_per_step;
    travel(input.shuttle_s);
}

void Helm::take(const FlightInput& input,
                const std::function<std::optional<OrbitView>(int number)>& rig_view) {
    const auto shot = [&](int number) -> std::optional<OrbitView>& {
        assert(number >= 1 && number <= static_cast<int>(shots_.size()));
        return shots_[static_cast<std::size_t>(number - 1)];
    };
    if (input.next_wheel_mode) next_mode();
    if (input.toggle_move && move_) {
        if (playing_) {
            leave_move();
        } else {
            // From where the wheel holds it, else from the start.
            if (!on_move_) move_s_ = 0;
            on_move_ = playing_ = true;
        }
    }
    if (input.store_shot) shot(input.store_shot) = view();
    if (input.turns_wheel()) take_wheel(input);
    if (!input.steers()) return;
    leave_move();
    camera_.orbit(input.orbit_azimuth_rad, input.orbit_elevation_rad);
    camera_.pan(input.pan_right_widths, input.pan_up_widths);
    camera_.dolly(input.dolly);
    camera_.zoom(input.zoom);
    if (input.reset) camera_.fly_to(start_);
    if (input.recall_shot) {
        const std::optional<OrbitView>& stored = shot(input.recall_shot);
        if (const std::optional<OrbitView> to = stored ? stored : rig_view(input.recall_shot))
            camera_.fly_to(*to);
    }
}

void Helm::advance(double dt_s) {
    assert(dt_s >= 0);
    camera_.advance(dt_s);
    if (!on_move_) return;
    if (playing_) travel(dt_s);
    const double step_s = pending_s_ * (1 - std::exp(-dt_s / wheel_follow_s));
    travel(step_s);
    pending_s_ -= step_s;
    joining_ = std::max(0.0, joining_ - dt_s / join_s);
}

}  // namespace vantage
