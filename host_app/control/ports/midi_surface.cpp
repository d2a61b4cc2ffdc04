#include "host_app/control/ports/midi_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "host_app/control/hid/jog_mapper.h"

namespace vantage {
namespace {

constexpr int pressed_from = 64, lower_half = 32, seven_bits = 7;
constexpr int most_fine_value = (1 << 14) - 1;
/// Largest number of encoder steps in one message; encoders that count fast turns send about ten. A
/// greater number means another encoding, in which one click would jump.
constexpr int most_clicks = 24;

/// Signed steps of an encoder's message; 0 if it did not turn.
int encoder_steps(MidiTravel travel, int value) {
    constexpr int half = 64;
    if (travel == MidiTravel::twos) return value < half ? value : value - 2 * half;
    if (travel == MidiTravel::binary_offset) return value - half;
    if (travel == MidiTravel::ends) return value < half ? -1 : 1;
    return value < half ? value : half - value;
}

/// Whether an encoder of this encoding sends the value: it never says that it did not turn.
bool is_of_encoding(MidiTravel travel, int value) {
    if (travel == MidiTravel::ends) return value == 0 || value == most_midi_value;
    return encoder_steps(travel, value) != 0;
}

/// Position -1..1 relative to the centre, which is rounded up if it is not an integer.
double stick_position(int value, int most) {
    const int middle = (most + 1) / 2, from = value - middle;
    return static_cast<double>(from) / (from < 0 ? middle : most - middle);
}

MidiControl control_of(const MidiMessage& message) {
    return {message.kind, message.kind == MidiKind::bend ? 0 : message.number, message.channel};
}

double factor_of(const AxisMap& map) { return map.sensitivity * (map.inverted ? -1 : 1); }

}  // namespace

MidiSurface::Outcome MidiSurface::take(const MidiMessage& message) {
    using Kind = Outcome::Kind;
    if (std::string fault = fault_of(message); !fault.empty())
        return {Kind::malformed, {}, std::move(fault)};
    const MidiControl control = control_of(message);
    std::erase_if(lit_, [&](const auto& lit) {
        const MidiControl& pad = lit.first;
        return pad.kind == control.kind && pad.number == control.number &&
               (pad.channel == 0 || pad.channel == control.channel);
    });
    // The low half belongs to its high half, even if its number is mapped too.
    if (message.kind == MidiKind::controller && message.number >= lower_half &&
        message.number < 2 * lower_half) {
        MidiMessage upper = message;
        upper.number -= lower_half;
        if (const MidiAxisMap* axis = map_->find_axis(upper); axis && axis->is_fine) {
            const auto found = upper_.find(control_of(upper));
            if (found == upper_.end()) return {};
            return move(*axis, control_of(upper), found->second << seven_bits | message.value,
                        most_fine_value);
        }
    }
    if (const ButtonMap* button = map_->find_button(message)) {
        const bool is_down =
            message.kind == MidiKind::note ? message.value > 0 : message.value >= pressed_from;
        if (!is_down) pressed_.erase(control);
        return is_down && pressed_.insert(control).second ? press(*button) : Outcome{};
    }
    if (const MidiAxisMap* axis = map_->find_axis(message)) {
        if (message.kind == MidiKind::bend)
            return move(*axis, control, message.value - least_bend, most_fine_value);
        if (!axis->is_fine) return move(*axis, control, message.value, most_midi_value);
        upper_[control] = message.value;
        return {};
    }
    return {Kind::unknown, {}, fmt::format("{} is mapped to nothing", to_text(control))};
}

MidiSurface::Outcome MidiSurface::press(const ButtonMap& map) {
    if (map.action == ButtonAction::store_next) is_storing_ = !is_storing_;
    if (map.action != ButtonAction::command) return {};
    static const ControlCommand* const shot = find_command("shot");
    static const ControlCommand* const store = find_command("store");
    Outcome outcome{.call = map.call};
    if (map.call.command == shot) {
        if (is_storing_) outcome.call->command = store;
        is_storing_ = false;
    }
    return outcome;
}

MidiSurface::Outcome MidiSurface::move(const MidiAxisMap& axis, const MidiControl& control,
                                       int value, int most) {
    if (axis.travel == MidiTravel::stick) {
        const double position = response_of(axis.map, stick_position(value, most));
        if (position == 0)
            sticks_.erase(control);
        else
            sticks_[control] = {axis.map, position};
        return {};
    }
    double steps = 0;
    if (axis.travel == MidiTravel::fader) {
        // The first message only sets the start position, so that nothing jumps.
        const double now = static_cast<double>(value) / most;
        const auto [was, is_first] = faders_.emplace(control, now);
        steps = is_first ? 0 : (now - was->second) * axis.travel_steps;
        was->second = now;
    } else {
        const int clicks = encoder_steps(axis.travel, value);
        std::string fault;
        if (!is_of_encoding(axis.travel, value))
            fault = fmt::format("the value {} is none of its encoding's", value);
        else if (std::abs(clicks) > most_clicks)
            fault = fmt::format(
                "the value {} would be {} steps at once, where a hand turns {} at "
                "most",
                value, clicks, most_clicks);
        if (!fault.empty())
            return {Outcome::Kind::malformed,
                    {},
                    fmt::format("{}: {}; its encoding is another (\"twos\", \"offset\" for 63 and "
                                "65, \"sign\", \"127/0\")",
                                to_text(control), fault)};
        steps = clicks;
    }
    steps = std::clamp(steps * factor_of(axis.map), -most_steps, most_steps);
    if (axis.map.action != AxisAction::command || steps == 0) return {};
    return {.call = CommandCall{axis.map.command, steps, {}}};
}

FlightInput MidiSurface::held(double dt_s) const {
    FlightInput input;
    for (const auto& [control, held] : sticks_) {
        const double gain = factor_of(held.map) * dt_s;
        if (held.map.action == AxisAction::shuttle)
            input.shuttle_s += shuttle_speed(held.position) * gain;
        else if (held.map.action == AxisAction::command)
            input.*held.map.command->amount.of +=
                held.position * held.map.command->amount.per_second * gain;
    }
    return input;
}

std::vector<MidiMessage> MidiSurface::due(const ShowLamps& shown) {
    std::vector<MidiMessage> messages;
    for (const MidiLampMap& each : map_->lamps()) {
        const LampValue value = each.lamp->of(shown);
        const bool is_on = std::get<bool>(value);
        const auto found = lit_.find(each.control);
        if (found != lit_.end() && found->second == is_on) continue;
        lit_[each.control] = is_on;
        messages.push_back({each.control.kind, std::max(each.control.channel, 1),
                            each.control.number, is_on ? each.on : each.off});
    }
    return messages;
}

}  // namespace vantage
