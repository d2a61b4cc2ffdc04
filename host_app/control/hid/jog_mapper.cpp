#include "host_app/control/hid/jog_mapper.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vantage {
namespace {

constexpr double deg = std::numbers::pi / 180;

/// What one detent does, and what a control at the end of its way does in a second.
struct Effect {
    double FlightInput::*amount;
    double per_step, per_second;
};

const Effect* effect_of(AxisAction action) {
    static constexpr Effect orbit{&FlightInput::orbit_azimuth_rad, 1 * deg, 60 * deg};
    static constexpr Effect elevate{&FlightInput::orbit_elevation_rad, 1 * deg, 40 * deg};
    static constexpr Effect pan_right{&FlightInput::pan_right_widths, 0.01, 0.4};
    static constexpr Effect pan_up{&FlightInput::pan_up_widths, 0.01, 0.4};
    static constexpr Effect dolly{&FlightInput::dolly, 0.02, 0.8};
    static constexpr Effect zoom{&FlightInput::zoom, 0.02, 0.6};
    static constexpr Effect wheel{&FlightInput::wheel_steps, 1, 30};
    switch (action) {
        case AxisAction::orbit:
            return &orbit;
        case AxisAction::elevate:
            return &elevate;
        case AxisAction::pan_right:
            return &pan_right;
        case AxisAction::pan_up:
            return &pan_up;
        case AxisAction::dolly:
            return &dolly;
        case AxisAction::zoom:
            return &zoom;
        case AxisAction::wheel:
            return &wheel;
        case AxisAction::shuttle:
        case AxisAction::nothing:
            break;
    }
    return nullptr;
}

}  // namespace

double shuttle_speed(double position) {
    constexpr std::array speeds{0.0, 0.1, 0.25, 0.33, 0.5, 0.75, 1.0, 2.0};
    const double at = std::min(std::abs(position), 1.0) * (speeds.size() - 1);
    const auto notch = std::min(static_cast<std::size_t>(at), speeds.size() - 2);
    const double part = at - static_cast<double>(notch);
    return std::copysign(speeds[notch] + part * (speeds[notch + 1] - speeds[notch]), position);
}

double without_dead_zone(double position, double dead_zone) {
    const double way = std::abs(position) - dead_zone;
    return way <= 0 ? 0 : std::copysign(std::min(way / (1 - dead_zone), 1.0), position);
}

void JogMapper::take(const DeckEvent& event) {
    switch (event.kind) {
        case DeckEvent::Kind::lost:
            // Its springs cannot centre it any more.
            std::erase_if(held_, [&](const auto& held) { return held.first.first == event.path; });
            storing_ = false;
            break;
        case DeckEvent::Kind::control:
            if (event.event.kind == JogKind::button)
                take_button(event);
            else
                take_axis(event);
            break;
        case DeckEvent::Kind::plugged:
        case DeckEvent::Kind::unread:
        case DeckEvent::Kind::report:
            break;
    }
}

void JogMapper::take_axis(const DeckEvent& event) {
    const auto found = event.profile->axes.find(event.event.control);
    if (found == event.profile->axes.end()) return;
    const AxisMap& map = found->second;
    if (event.event.kind == JogKind::axis) {
        const std::pair key(event.path, event.event.control);
        const double position = without_dead_zone(event.event.value, map.dead_zone);
        if (position == 0)
            held_.erase(key);
        else
            held_[key] = {map, position};
        return;
    }
    const double steps = event.event.value * map.sensitivity * (map.inverted ? -1 : 1);
    if (const Effect* effect = effect_of(map.action))
        input_.*effect->amount += steps * effect->per_step;
}

void JogMapper::take_button(const DeckEvent& event) {
    const auto found = event.profile->buttons.find(event.event.control);
    if (found == event.profile->buttons.end() || event.event.value == 0) return;
    switch (found->second.action) {
        case ButtonAction::shot:
            (storing_ ? input_.store_shot : input_.recall_shot) = found->second.number;
            storing_ = false;
            break;
        case ButtonAction::store:
            storing_ = !storing_;
            break;
        case ButtonAction::freeze:
            input_.toggle_freeze = !input_.toggle_freeze;
            break;
        case ButtonAction::mode:
            input_.next_wheel_mode = true;
            break;
        case ButtonAction::play:
            input_.toggle_move = !input_.toggle_move;
            break;
        case ButtonAction::reset:
            input_.reset = true;
            break;
        case ButtonAction::synthesiser:
            input_.next_synthesiser = true;
            break;
        case ButtonAction::live:
            input_.to_live = true;
            break;
        case ButtonAction::mark_in:
            input_.mark_in = true;
            break;
        case ButtonAction::mark_out:
            input_.mark_out = true;
            break;
        case ButtonAction::no_marks:
            input_.clear_marks = true;
            break;
        case ButtonAction::loop:
            input_.toggle_loop = !input_.toggle_loop;
            break;
        case ButtonAction::cue:
            input_.cue = true;
            break;
        case ButtonAction::slower:
            --input_.speed_steps;
            break;
        case ButtonAction::faster:
            ++input_.speed_steps;
            break;
        case ButtonAction::nothing:
            break;
    }
}

FlightInput JogMapper::input(double dt_s) {
    FlightInput taken = input_;
    input_ = {};
    for (const auto& [key, held] : held_) {
        const double gain = held.map.sensitivity * (held.map.inverted ? -1 : 1) * dt_s;
        if (held.map.action == AxisAction::shuttle)
            taken.shuttle_s += shuttle_speed(held.position) * gain;
        else if (const Effect* effect = effect_of(held.map.action))
            taken.*effect->amount += held.position * effect->per_second * gain;
    }
    return taken;
}

}  // namespace vantage
