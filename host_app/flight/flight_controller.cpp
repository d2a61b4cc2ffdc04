#include "host_app/flight/flight_controller.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/flight/moves/move.h"

namespace vantage {
namespace {

constexpr double rad_per_step = std::numbers::pi / 180;
constexpr double rad_per_shuttle_s = 30 * std::numbers::pi / 180;
constexpr double move_s_per_step = 0.1;
/// Time constant of the travel along the move after a step of the wheel.
constexpr double wheel_follow_s = 0.08;
constexpr double join_s = 0.8;
/// Duration of the turn to another pivot.
constexpr double look_s = 0.8;
/// Ratio of the highest to the mean speed of a flight with Easing::ease.
constexpr double ease_peak = 1.5;

OrbitView mixed(const OrbitView& a, OrbitView b, double share_of_b) {
    b.azimuth_rad = nearest_turn(b.azimuth_rad, a.azimuth_rad);
    const auto mix = [&](double from, double to) { return from + share_of_b * (to - from); };
    OrbitView view;
    view.pivot_m = a.pivot_m + share_of_b * (b.pivot_m - a.pivot_m);
    view.azimuth_rad = mix(a.azimuth_rad, b.azimuth_rad);
    view.elevation_rad = mix(a.elevation_rad, b.elevation_rad);
    view.distance_m = mix(a.distance_m, b.distance_m);
    view.field_of_view_rad = mix(a.field_of_view_rad, b.field_of_view_rad);
    view.roll_rad = mix(a.roll_rad, nearest_turn(b.roll_rad, a.roll_rad));
    return view;
}

/// Duration of the fastest flight from rest to rest within the speed limits.
double min_flight_s(const OrbitView& a, const OrbitView& b, const FlightLimits& limits) {
    const double turn_rad =
        std::max({std::abs(nearest_turn(b.azimuth_rad, a.azimuth_rad) - a.azimuth_rad),
                  std::abs(b.elevation_rad - a.elevation_rad),
                  std::abs(nearest_turn(b.roll_rad, a.roll_rad) - a.roll_rad)});
    const double way_m =
        std::max((b.pivot_m - a.pivot_m).norm(), std::abs(b.distance_m - a.distance_m));
    const double zoom_rad = std::abs(b.field_of_view_rad - a.field_of_view_rad);
    return ease_peak * std::max({turn_rad / limits.max_turn_rad_s, way_m / limits.max_speed_m_s,
                                 zoom_rad / limits.max_zoom_rad_s});
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

FlightController::FlightController(const OrbitView& start, std::optional<Move> move, bool has_past,
                                   const FlightHabits& habits)
    : camera_(start, habits.applied_to({})),
      start_(start),
      limits_(habits.applied_to({})),
      has_past_(has_past),
      holds_horizon_(habits.holds_horizon),
      habits_(habits),
      move_(std::move(move)) {
    if (!move_) return;
    on_move_ = playing_ = true;
    mode_ = WheelMode::move;
}

void FlightController::settle(const FlightLimits& limits, const std::optional<OrbitView>& start) {
    limits_ = habits_.applied_to(limits);
    if (start) start_ = *start;
    camera_ = OrbitCamera(start ? *start : camera_.view(), limits_);
    camera_.keep_within(corridor_);
}

void FlightController::keep(const FlightBook& book) {
    shots_ = book.shots;
    if (!move_) move_ = book.move;
}

void FlightController::keep_flight(Move move) {
    leave_move();
    set_move(std::move(move));
    move_s_ = 0;
}

void FlightController::set_move(std::optional<Move> move) {
    const double place = move_ ? place_s() : 0;
    if (on_move_ && move) {
        // The camera stays on the move, and glides over to the new one.
        joined_from_ = view();
        joining_ = 1;
    } else {
        leave_move();
    }
    pending_s_ = 0;
    move_ = std::move(move);
    move_s_ = move_ ? std::min(place, move_->duration_s()) : 0;
    if (!move_ && mode_ == WheelMode::move) mode_ = WheelMode::orbit;
    is_changed_ = is_move_changed_ = true;
}

std::optional<FlightController::Change> FlightController::take_change() {
    if (!std::exchange(is_changed_, false)) return std::nullopt;
    return Change{{move_, shots_, limits_.min_eye_height_m},
                  std::exchange(is_move_changed_, false)};
}

void FlightController::stand_at(const CameraState& camera) {
    take_in_hand();
    camera_.jump_to(taken_over(camera, limits_, camera_.view().azimuth_rad));
}

void FlightController::fly_over_to(const FlightController& other, double duration_s) {
    take_in_hand();
    holds_horizon_ = other.holds_horizon_;
    fly_to(other.view(), duration_s, Easing::ease);
}

void FlightController::halt() {
    take_in_hand();
    camera_.jump_to(camera_.view());
}

void FlightController::share(const Change& change) {
    shots_ = change.book.shots;
    if (!change.is_of_move) return;
    const bool was_changed = is_changed_, was_move_changed = is_move_changed_;
    set_move(change.book.move);
    is_changed_ = was_changed;
    is_move_changed_ = was_move_changed;
}

std::optional<double> FlightController::flight_progress() const {
    if (!shot_flight_) return std::nullopt;
    return shot_flight_->gone_s / shot_flight_->duration_s;
}

OrbitView FlightController::view() const {
    if (!on_move_) return camera_.view();
    OrbitView on_move = move_->at(move_s_);
    if (joining_ <= 0) return on_move;
    const double gone = 1 - joining_;
    const OrbitView view = mixed(joined_from_, on_move, eased(gone));
    return move_->path() == MovePath::orbit ? constrained(view, limits_) : view;
}

std::optional<double> FlightController::move_progress() const {
    if (!on_move_) return std::nullopt;
    if (move_->duration_s() == 0) return 0;
    return place_s() / move_->duration_s();
}

std::optional<double> FlightController::move_take_s() const {
    return on_move_ ? move_->take_s_at(move_s_) : std::nullopt;
}

void FlightController::leave_move() {
    if (!on_move_) return;
    camera_.jump_to(taken_over(view().camera(), limits_, view().azimuth_rad));
    on_move_ = playing_ = false;
    pending_s_ = joining_ = 0;
}

void FlightController::take_in_hand() {
    leave_move();
    shot_flight_.reset();
}

void FlightController::toggle_pause() {
    if (on_move_) playing_ = !playing_;
}

void FlightController::join_move() {
    playing_ = false;
    if (on_move_) return;
    shot_flight_.reset();
    joined_from_ = camera_.view();
    joining_ = 1;
    on_move_ = true;
}

void FlightController::travel(double seconds) {
    move_s_ += seconds;
    if (!move_->loops()) move_s_ = std::clamp(move_s_, 0.0, move_->duration_s());
}

void FlightController::obey(const command::NextWheelMode&, const Surroundings&) {
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

void FlightController::take_wheel(const FlightInput& input) {
    if (mode_ == WheelMode::past) return;
    if (mode_ == WheelMode::orbit) {
        take_in_hand();
        camera_.orbit(input.wheel_steps * rad_per_step + input.shuttle_s * rad_per_shuttle_s, 0);
        return;
    }
    join_move();
    pending_s_ += input.wheel_steps * move_s_per_step;
    travel(input.shuttle_s);
}

std::optional<Shot>& FlightController::shot(int number) {
    assert(number >= 1 && number <= static_cast<int>(shots_.size()));
    return shots_[static_cast<std::size_t>(number - 1)];
}

void FlightController::carry_pivot_to(const Eigen::Vector3d& pivot_m) {
    if (!on_move_ && !shot_flight_) camera_.carry_pivot_to(pivot_m);
}

void FlightController::obey(const command::LookAt& look, const Surroundings&) {
    take_in_hand();
    const OrbitView here = camera_.view();
    const Eigen::Vector3d eye = here.eye_m();
    if ((look.point_m - eye).norm() < limits_.min_distance_m) return;
    OrbitView there = view_from_eye(eye, look.point_m, here.field_of_view_rad, here.azimuth_rad);
    there.roll_rad = here.roll_rad;
    fly_to(taken_over(there.camera(), limits_, there.azimuth_rad), look_s, Easing::ease);
}

void FlightController::fly_to(const OrbitView& asked, double duration_s, Easing easing) {
    OrbitView view = asked;
    if (holds_horizon_) view.roll_rad = 0;
    const bool is_held =
        !corridor_ || corridor_->of(constrained(view, limits_).camera()).share >= Corridor::end;
    // Towards a view outside the corridor the camera goes as far as the corridor allows.
    if (!is_held) {
        camera_.fly_to(view);
        return;
    }
    const OrbitView from = camera_.view(), to = constrained(view, limits_);
    if (duration_s == 0) {
        camera_.jump_to(to);
        return;
    }
    shot_flight_ = {from, to, std::max(duration_s, min_flight_s(from, to, limits_)), 0, easing};
}

double FlightController::place_s() const {
    const double end_s = move_->duration_s();
    if (move_->loops()) return move_s_ - end_s * std::floor(move_s_ / end_s);
    return std::clamp(move_s_, 0.0, end_s);
}

bool FlightController::has_room_for_keyframe() const {
    if (keyframes() < most_keyframes) return true;
    log_warning("the move already has {} keyframes, the maximum; remove one to add another",
                most_keyframes);
    return false;
}

void FlightController::obey(const command::AddKeyframe&, const Surroundings& surroundings) {
    if (!has_room_for_keyframe()) return;
    set_move(appended(move_, view(), surroundings.take_s, habits_.keyframe_gap_s, limits_));
    move_s_ = move_->duration_s();
}

void FlightController::obey(const command::SetKeyframe&, const Surroundings& surroundings) {
    if (!move_) return obey(command::AddKeyframe{}, surroundings);
    if (!has_room_for_keyframe()) return;
    set_move(with_view_at(*move_, place_s(), view(), surroundings.take_s));
}

void FlightController::obey(const command::RemoveKeyframe&, const Surroundings&) {
    if (move_) set_move(without_keyframe(*move_, nearest_keyframe(*move_, place_s())));
}

void FlightController::retime(double later_s) {
    if (!move_) return;
    const std::size_t nearest = nearest_keyframe(*move_, place_s());
    set_move(retimed(*move_, nearest, later_s));
    move_s_ = move_->keyframes()[nearest].time_s;
}

void FlightController::obey(const command::JumpKeyframes& jump, const Surroundings&) {
    if (!move_) return;
    const std::vector<MoveKeyframe>& keyframes = move_->keyframes();
    // The position that the camera is already on its way to, within the ends of the move.
    const double here_s = move_->loops()
                              ? place_s() + pending_s_
                              : std::clamp(place_s() + pending_s_, 0.0, move_->duration_s());
    // A keyframe at the present position is not a target.
    constexpr double same_s = 0.01;
    const int step = jump.count > 0 ? 1 : -1;
    double there_s = here_s;
    for (int i = 0; i != jump.count; i += step) {
        const double from_s = there_s;
        for (const MoveKeyframe& keyframe : keyframes) {
            if (step > 0 && keyframe.time_s > from_s + same_s) {
                there_s = keyframe.time_s;
                break;
            }
            if (step < 0 && keyframe.time_s < from_s - same_s) there_s = keyframe.time_s;
        }
    }
    join_move();
    pending_s_ = there_s - place_s();
}

void FlightController::obey(const command::ToggleHorizon&, const Surroundings&) {
    holds_horizon_ = !holds_horizon_;
}

void FlightController::obey(const command::ToggleMove&, const Surroundings&) {
    if (!move_) return;
    if (playing_) return leave_move();
    // The move plays from where the wheel holds it, otherwise from its start.
    if (!on_move_) move_s_ = 0;
    shot_flight_.reset();
    on_move_ = playing_ = true;
}

void FlightController::obey(const command::StoreShot& store, const Surroundings&) {
    std::optional<Shot>& place = shot(store.number);
    if (!place) place = Shot{fmt::format("shot {}", store.number), {}, habits_.shot_s};
    place->view = view();
    is_changed_ = true;
}

void FlightController::obey(const command::ResetView&, const Surroundings&) {
    take_in_hand();
    fly_to(start_, habits_.shot_s, Easing::ease);
}

void FlightController::obey(const command::RecallShot& recall, const Surroundings& surroundings) {
    take_in_hand();
    if (const std::optional<Shot>& stored = shot(recall.number))
        fly_to(stored->view, stored->duration_s, stored->easing);
    else if (const std::optional<OrbitView> to = surroundings.rig_view(recall.number))
        fly_to(*to, habits_.shot_s, Easing::ease);
}

void FlightController::take_axes(const FlightInput& input) {
    if (input.retime_s != 0) retime(input.retime_s);
    if (input.turns_wheel()) take_wheel(input);
    if (!input.turns_camera()) return;
    take_in_hand();
    camera_.orbit(input.orbit_azimuth_rad, input.orbit_elevation_rad);
    camera_.pan(input.pan_right_widths, input.pan_up_widths);
    camera_.dolly(input.dolly);
    camera_.zoom(input.zoom);
    camera_.crane(input.crane_up_widths);
    camera_.look(input.look_right_rad, input.look_up_rad);
    if (!holds_horizon_) camera_.roll(input.roll_rad);
}

void FlightController::take(const FlightInput& input, const RigView& rig_view,
                            std::optional<double> take_s) {
    take_axes(input);
    const Surroundings surroundings{rig_view, take_s};
    input.for_each<FlightCommand>([&](const auto& each) { obey(each, surroundings); });
}

void FlightController::advance(double dt_s) {
    assert(dt_s >= 0);
    if (shot_flight_) {
        ShotFlight& flight = *shot_flight_;
        flight.gone_s = std::min(flight.gone_s + dt_s, flight.duration_s);
        const double s = flight.gone_s / flight.duration_s;
        camera_.jump_to(
            mixed(flight.from, flight.to, flight.easing == Easing::linear ? s : eased(s)));
        if (s >= 1) shot_flight_.reset();
    }
    if (holds_horizon_) camera_.level();
    camera_.advance(dt_s);
    if (!on_move_) return;
    if (playing_) travel(dt_s);
    const double step_s = pending_s_ * (1 - std::exp(-dt_s / wheel_follow_s));
    travel(step_s);
    pending_s_ -= step_s;
    joining_ = std::max(0.0, joining_ - dt_s / join_s);
}

}  // namespace vantage
