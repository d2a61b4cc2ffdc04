#include "host_app/control/flight_controls.h"

#include <algorithm>

#include <fmt/format.h>

namespace vantage {
namespace {

/// Nobody presses more between two looks of the session.
constexpr std::size_t most_waiting_outputs = 64;

OrbitView orbit_of(const CameraState& camera, double near_azimuth_rad) {
    const Eigen::Vector3d eye = camera.world_from_camera.translation();
    const Eigen::Vector3d forward = camera.world_from_camera.linear().col(2);
    return view_from_eye(eye, eye + camera.focus_m * forward, camera.field_of_view_rad,
                         near_azimuth_rad);
}

}  // namespace

bool HandsBox::put(const FlightInput& input, MonotonicTime now) {
    if (!input.is_any()) return true;
    const std::lock_guard lock(mutex_);
    const bool has_to_wait = !waiting_.empty() && waiting_.back().input.commands_twice(input);
    if (has_to_wait && waiting_.size() == most_waiting) {
        waiting_.back().input.add(input.turns());
        return false;
    }
    if (waiting_.empty() || has_to_wait) waiting_.push_back({{}, now});
    waiting_.back().input.add(input);
    return true;
}

HandsBox::Taken HandsBox::take() {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty()) return {};
    Taken taken = waiting_.front();
    waiting_.pop_front();
    return taken;
}

FlightControls::FlightControls(Settings settings, JogDeck* deck, RigView rig_view, Framing framing,
                               CorridorNow corridor)
    : settings_(std::move(settings)),
      helm_(settings_.plan.start.value_or(OrbitView{}), settings_.plan.move, settings_.has_past),
      deck_(deck),
      rig_view_(std::move(rig_view)),
      framing_(std::move(framing)),
      corridor_now_(std::move(corridor)) {}

PilotStep FlightControls::step(double time_s) {
    const double dt_s = time_s - last_s_;
    last_s_ = time_s;
    if (framing_) {
        if (const std::optional<StageFraming> framing = framing_()) {
            helm_.settle(framing->limits,
                         settings_.plan.start ? std::nullopt : std::optional(framing->start));
            framing_ = {};
        }
    }
    const std::shared_ptr<const Corridor> corridor = corridor_now_ ? corridor_now_() : nullptr;
    if (!settings_.free_flight) helm_.keep_within(corridor);
    auto [hands, since] = hands_.take();
    if (deck_) {
        while (const std::optional<DeckEvent> event = deck_->next()) {
            mapper_.take(*event);
            if (event->kind == DeckEvent::Kind::control && (!since || event->time < *since))
                since = event->time;
        }
        hands.add(mapper_.input(dt_s));
    }
    PilotStep step;
    step.hand = since;
    step.next_synthesiser = hands.next_synthesiser;
    step.toggle_source_map = hands.toggle_novelty;
    step.time = {.pulses = hands.past_steps,
                 .speed_steps = hands.speed_steps,
                 .toggle_hold = hands.toggle_freeze,
                 .to_live = hands.to_live,
                 .mark_in = hands.mark_in,
                 .mark_out = hands.mark_out,
                 .clear_marks = hands.clear_marks,
                 .toggle_loop = hands.toggle_loop,
                 .cue = hands.cue};
    if (helm_.wheel_mode() == WheelMode::past)
        step.time.pulses += hands.wheel_steps + hands.shuttle_s * settings_.pulse_rate_hz;
    fly(hands, dt_s, step);
    note_coverage(corridor.get(), step.camera.value_or(step.view.camera()), dt_s);
    const std::lock_guard lock(mutex_);
    wishes_.toggle_take ^= hands.toggle_take;
    wishes_.save_set |= hands.save_set;
    wishes_.learn_set |= hands.learn_set;
    if (hands.toggle_output != 0 && wishes_.outputs.size() < most_waiting_outputs)
        wishes_.outputs.push_back(hands.toggle_output);
    lines_ = {is_tracked_ ? std::nullopt : helm_.move_progress(), name_of(helm_.wheel_mode()),
              is_tracked_, wheel_line(), corridor_books_};
    return step;
}

void FlightControls::fly(const FlightInput& hands, double dt_s, PilotStep& step) {
    if (hands.toggle_tracking) may_track_ = !may_track_;
    const bool wheel_steers = hands.turns_wheel() && helm_.wheel_mode() != WheelMode::past;
    if (hands.steers() || hands.toggle_move || wheel_steers) may_track_ = false;
    const std::optional<CameraState> tracked =
        may_track_ ? tracked_.newest(MonotonicClock::now()) : std::nullopt;
    // Before the hands, so that they steer on from there.
    if (tracked) helm_.stand_at(orbit_of(*tracked, helm_.view().azimuth_rad));
    if (tracked.has_value() != is_tracked_) {
        is_tracked_ = tracked.has_value();
        glide_.begin();
    }
    helm_.take(hands, rig_view_);
    helm_.advance(dt_s);
    step.view = helm_.view();
    const CameraState shown = glide_.step(tracked.value_or(step.view.camera()), dt_s);
    if (is_tracked_ || !glide_.is_over()) step.camera = shown;
}

SessionWishes FlightControls::take_wishes() {
    const std::lock_guard lock(mutex_);
    return std::exchange(wishes_, {});
}

void FlightControls::note_coverage(const Corridor* corridor, const CameraState& camera,
                                   double dt_s) {
    if (!corridor) return;
    const Coverage now = corridor->of(camera);
    corridor_books_.now = now;
    corridor_books_.least_share = std::min(corridor_books_.least_share, now.share);
    switch (Corridor::place_of(now.share)) {
        case CorridorPlace::inside:
            break;
        case CorridorPlace::edge:
            corridor_books_.edge_s += dt_s;
            break;
        case CorridorPlace::beyond:
            corridor_books_.beyond_s += dt_s;
            break;
    }
}

FlightControls::Lines FlightControls::lines() const {
    const std::lock_guard lock(mutex_);
    return lines_;
}

std::string FlightControls::wheel_line() const {
    if (!deck_) return "";
    std::string names, fault;
    for (const DeckDevice& device : deck_->devices()) {
        if (device.usable)
            names += (names.empty() ? "" : ", ") + device.model;
        else if (!device.fault.empty())
            fault = device.fault;
    }
    if (names.empty()) return fault;
    return fmt::format("{} drives the {}{}", names, name_of(helm_.wheel_mode()),
                       mapper_.is_storing() ? "; the next shot button stores" : "");
}

}  // namespace vantage
