#include "host_app/control/flight_controls.h"

#include <algorithm>

#include <fmt/format.h>

namespace vantage {

void HandsBox::put(const FlightInput& input, MonotonicTime now) {
    if (!input.is_any()) return;
    const std::lock_guard lock(mutex_);
    taken_.input.add(input);
    if (!taken_.since) taken_.since = now;
}

HandsBox::Taken HandsBox::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(taken_, {});
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
    helm_.take(hands, rig_view_);
    helm_.advance(dt_s);
    step.view = helm_.view();
    note_coverage(corridor.get(), step.view, dt_s);
    const std::lock_guard lock(mutex_);
    lines_ = {helm_.move_progress(), wheel_line(), corridor_books_};
    return step;
}

void FlightControls::note_coverage(const Corridor* corridor, const OrbitView& view, double dt_s) {
    if (!corridor) return;
    const Coverage now = corridor->of(view.camera());
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
