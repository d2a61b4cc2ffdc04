#include "host_app/desk/panels/wheel_panel.h"

#include <algorithm>

#include "host_app/control/table/control_command.h"

namespace vantage {

std::vector<DeskWheel::Choice> wheel_choices(DeskWheel::Kind kind) {
    std::vector<DeskWheel::Choice> choices{{"nothing", "no command"}};
    if (kind == DeskWheel::Kind::button) {
        choices.push_back({"store", "the next shot button stores the view"});
        for (const std::string& action : button_commands())
            choices.push_back({action, parse_button_command(action)->command->does});
        return choices;
    }
    if (kind == DeskWheel::Kind::axis)
        choices.push_back({"shuttle", "the speed of the wheel's mode"});
    for (const ControlCommand& command : control_commands())
        if (command.argument == CommandArgument::steps)
            choices.push_back({command.name, command.does});
    return choices;
}

void WheelPanel::follow(std::optional<DeskWheel>& wheel) {
    is_open_ = wheel.has_value();
    if (!wheel) return choose(false);
    const bool has_control = wheel->selected < wheel->controls.size();
    const DeskWheel::Kind kind =
        has_control ? wheel->controls[wheel->selected].kind : DeskWheel::Kind::button;
    // The choice belonged to another control.
    if (!has_control || wheel->selected != selected_ || kind != kind_) choose(false);
    selected_ = wheel->selected;
    kind_ = kind;
    names_.clear();
    for (const DeskWheel::Control& control : wheel->controls) names_.push_back(control.name);
    has_feel_ = wheel->feel.has_value();
    wheel->is_choosing = is_choosing_;
    wheel->typed = typed_;
    wheel->choices = choices_;
    wheel->chosen = chosen_;
    wheel->feel_in_hand = feel_in_hand_;
}

void WheelPanel::choose(bool is_choosing) {
    is_choosing_ = is_choosing;
    typed_.clear();
    narrow();
}

void WheelPanel::narrow() {
    choices_.clear();
    chosen_ = 0;
    if (!is_choosing_) return;
    choices_ = wheel_choices(kind_);
    std::erase_if(choices_, [&](const DeskWheel::Choice& choice) {
        return choice.action.find(typed_) == std::string::npos;
    });
    // Commands that begin with the typed text come first.
    std::stable_partition(choices_.begin(), choices_.end(), [&](const DeskWheel::Choice& choice) {
        return choice.action.starts_with(typed_);
    });
}

void WheelPanel::type(unsigned codepoint) {
    constexpr std::size_t max_letters = 32;
    constexpr unsigned last_of_ascii = 126;
    if (!is_open_ || names_.empty() || codepoint < ' ' || codepoint > last_of_ascii ||
        typed_.size() >= max_letters)
        return;
    if (!is_choosing_) choose(true);
    typed_ += static_cast<char>(codepoint);
    narrow();
}

std::optional<WheelCall> WheelPanel::press(Key key) {
    using Action = WheelCall::Action;
    if (is_choosing_) return press_while_choosing(key);
    constexpr std::size_t feels = 4;  // steps, dead zone, curve, inverted
    switch (key) {
        case Key::up:
            return WheelCall{Action::select_by, -1};
        case Key::down:
            return WheelCall{Action::select_by, 1};
        case Key::left:
        case Key::right:
            if (!has_feel_) return std::nullopt;
            return feel(key == Key::left ? -1 : 1);
        case Key::tab:
            feel_in_hand_ = (feel_in_hand_ + 1) % feels;
            return std::nullopt;
        case Key::enter:
            if (!names_.empty()) choose(true);
            return std::nullopt;
        case Key::escape:
            return WheelCall{Action::close};
        case Key::backspace:
            break;
    }
    return std::nullopt;
}

std::optional<WheelCall> WheelPanel::press_while_choosing(Key key) {
    switch (key) {
        case Key::up:
            if (chosen_ > 0) --chosen_;
            break;
        case Key::down:
            if (chosen_ + 1 < choices_.size()) ++chosen_;
            break;
        case Key::enter:
            if (chosen_ < choices_.size()) {
                const WheelCall call{WheelCall::Action::assign, 0, choices_[chosen_].action};
                choose(false);
                return call;
            }
            break;
        case Key::backspace:
            if (typed_.empty()) {
                choose(false);
            } else {
                typed_.pop_back();
                narrow();
            }
            break;
        case Key::escape:
            choose(false);
            break;
        case Key::left:
        case Key::right:
        case Key::tab:
            break;
    }
    return std::nullopt;
}

WheelCall WheelPanel::feel(int steps) const {
    constexpr WheelCall::Action actions[] = {WheelCall::Action::steps, WheelCall::Action::dead_zone,
                                             WheelCall::Action::curve, WheelCall::Action::invert};
    return {actions[feel_in_hand_], steps};
}

WheelCall WheelPanel::press_control(int number) {
    choose(false);
    return {WheelCall::Action::select, 0, names_.at(static_cast<std::size_t>(number - 1))};
}

}  // namespace vantage
