#include "host_app/control/hid/jog_mapper.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage {
double shuttle_speed(double position) {
    constexpr std::array speeds{0.0, 0.1, 0.25, 0.33, 0.5, 0.75, 1.0, 2.0};
    const double at = std::min(std::abs(position), 1.0) * (speeds.size() - 1);
    const auto notch = std::min(static_cast<std::size_t>(at), speeds.size() - 2);
    const double part = at - static_cast<double>(notch);
    return std::copysign(speeds[notch] + part * (speeds[notch + 1] - speeds[notch]), position);
}

void JogMapper::let_go() {
    held_.clear();
    input_ = {};
    storing_ = false;
}

void JogMapper::take(const DeckEvent& event) {
    switch (event.kind) {
        case DeckEvent::Kind::lost:
            // The springs of a lost device cannot centre its axes any more.
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
        const double position = response_of(map, event.event.value);
        if (position == 0)
            held_.erase(key);
        else
            held_[key] = {map, position};
        return;
    }
    if (map.action != AxisAction::command) return;
    const double steps = event.event.value * map.sensitivity * (map.inverted ? -1 : 1);
    apply({map.command, steps}, input_);
}

void JogMapper::take_button(const DeckEvent& event) {
    const auto found = event.profile->buttons.find(event.event.control);
    if (found == event.profile->buttons.end() || event.event.value == 0) return;
    const ButtonMap& map = found->second;
    if (map.action == ButtonAction::store_next) storing_ = !storing_;
    if (map.action != ButtonAction::command) return;
    static const ControlCommand* const shot = find_command("shot");
    static const ControlCommand* const store = find_command("store");
    const bool is_shot = map.call.command == shot;
    apply(is_shot && storing_ ? CommandCall{store, map.call.argument} : map.call, input_);
    if (is_shot) storing_ = false;
}

FlightInput JogMapper::input(double dt_s) {
    FlightInput taken = input_;
    input_ = {};
    for (const auto& [key, held] : held_) {
        const double gain = held.map.sensitivity * (held.map.inverted ? -1 : 1) * dt_s;
        if (held.map.action == AxisAction::shuttle)
            taken.shuttle_s += shuttle_speed(held.position) * gain;
        else if (held.map.action == AxisAction::command)
            taken.*held.map.command->amount.of +=
                held.position * held.map.command->amount.per_second * gain;
    }
    return taken;
}

}  // namespace vantage
