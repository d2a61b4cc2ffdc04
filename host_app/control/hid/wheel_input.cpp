#include "host_app/control/hid/wheel_input.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/config/toml_edit.h"

namespace vantage {
namespace {

/// Time that the desk shows a turn of a control.
constexpr std::chrono::milliseconds turn_shown{600};

/// True for files that belong to an installed package.
bool is_packaged(const WheelProfile& profile) {
    return profile.is_built_in || profile.file.string().starts_with("/usr/");
}

std::filesystem::path saved_file_of(const WheelProfile& profile) {
    return is_packaged(profile) ? user_wheel_folder() / profile.file.filename() : profile.file;
}

std::string axis_table(const JogControl& control) { return "axes." + control.name; }

}  // namespace

std::string action_of(const WheelProfile& profile, const JogControl& control) {
    if (control.kind == JogKind::button) {
        const auto found = profile.buttons.find(control.name);
        if (found == profile.buttons.end()) return does_nothing;
        const ButtonMap& map = found->second;
        if (map.action == ButtonAction::store_next) return "store";
        if (map.action != ButtonAction::command) return does_nothing;
        return map.call.command->argument == CommandArgument::number
                   ? fmt::format("{} {:g}", map.call.command->name, map.call.argument)
                   : map.call.command->name;
    }
    const auto found = profile.axes.find(control.name);
    if (found == profile.axes.end()) return does_nothing;
    if (found->second.action == AxisAction::shuttle) return "shuttle";
    return found->second.action == AxisAction::command ? found->second.command->name : does_nothing;
}

void WheelInput::note(DeckEvent& event) {
    const std::lock_guard lock(mutex_);
    const auto [entry, is_new] = wheels_.try_emplace(event.profile->devices);
    Wheel& wheel = entry->second;
    if (is_new) {
        wheel.profile = event.profile;
        wheel.saved_text = event.profile->text;
        wheel.controls = controls_of(*event.profile);
    }
    event.profile = wheel.profile;
    if (event.kind == DeckEvent::Kind::lost) wheel.at.clear();
    if (event.kind == DeckEvent::Kind::plugged && in_hand_.empty()) in_hand_ = entry->first;
    if (event.kind != DeckEvent::Kind::control) return;
    in_hand_ = entry->first;
    note_control(wheel, event.event, event.time);
}

void WheelInput::note_control(Wheel& wheel, const JogEvent& event, MonotonicTime time) {
    const auto found =
        std::find_if(wheel.controls.begin(), wheel.controls.end(), [&](const JogControl& control) {
            return control.kind == event.kind && control.name == event.control;
        });
    if (found == wheel.controls.end()) return;
    if (event.kind == JogKind::step) {
        wheel.at[event.control] += event.value;
        wheel.turned =
            time - wheel.turned_at < turn_shown ? wheel.turned + event.value : event.value;
        wheel.turned_at = time;
    } else {
        wheel.at[event.control] = event.value;
    }
    // A ring that returns to rest or a released button does not change the selection.
    if (event.value != 0) wheel.selected = static_cast<std::size_t>(found - wheel.controls.begin());
}

void WheelInput::serve_desk() {
    const std::lock_guard lock(mutex_);
    has_desk_ = true;
}

void WheelInput::toggle() {
    const std::lock_guard lock(mutex_);
    is_open_ = has_desk_ && !is_open_;
    remark_.clear();
}

bool WheelInput::is_open() const {
    const std::lock_guard lock(mutex_);
    return is_open_;
}

void WheelInput::obey(const WheelCall& call) {
    std::vector<JogId> devices;
    Wheel wheel;
    {
        const std::lock_guard lock(mutex_);
        remark_.clear();
        if (call.action == WheelCall::Action::close) is_open_ = false;
        const auto found = wheels_.find(in_hand_);
        if (!is_open_ || found == wheels_.end() || found->second.controls.empty()) return;
        devices = in_hand_;
        wheel = found->second;
    }
    // The programme's thread reads the maps at every tick and must not wait for a file.
    const std::size_t selected = wheel.selected;
    std::string remark;
    try {
        remark = obey(wheel, call);
    } catch (const Error& error) {
        remark = error.what();
    }
    const std::lock_guard lock(mutex_);
    Wheel& kept = wheels_.at(devices);
    kept.profile = std::move(wheel.profile);
    kept.saved_text = std::move(wheel.saved_text);
    if (wheel.selected != selected) kept.selected = wheel.selected;
    remark_ = std::move(remark);
}

std::string WheelInput::obey(Wheel& wheel, const WheelCall& call) {
    const auto count = static_cast<int>(wheel.controls.size());
    switch (call.action) {
        case WheelCall::Action::select_by:
            wheel.selected = static_cast<std::size_t>(
                std::clamp(static_cast<int>(wheel.selected) + call.amount, 0, count - 1));
            break;
        case WheelCall::Action::select:
            for (std::size_t i = 0; i < wheel.controls.size(); ++i)
                if (wheel.controls[i].name == call.words) wheel.selected = i;
            break;
        case WheelCall::Action::assign:
            assign(wheel, call.words);
            break;
        case WheelCall::Action::steps:
        case WheelCall::Action::dead_zone:
        case WheelCall::Action::curve:
        case WheelCall::Action::invert:
            feel(wheel, call);
            break;
        case WheelCall::Action::save:
            return save(wheel);
        case WheelCall::Action::close:
            break;
    }
    return "";
}

void WheelInput::set(Wheel& wheel, const std::string& table, const std::string& key,
                     const std::string& value) {
    const WheelProfile& old = *wheel.profile;
    auto changed = std::make_shared<WheelProfile>(
        read_wheel_profile(with_toml_value(old.text, table, key, value, old.file), old.file));
    changed->is_built_in = old.is_built_in;
    wheel.profile = std::move(changed);
}

void WheelInput::assign(Wheel& wheel, const std::string& action) {
    const JogControl& control = wheel.controls[wheel.selected];
    const std::string value = toml_string(action);
    if (control.kind == JogKind::button)
        set(wheel, "buttons", control.name, value);
    else
        set(wheel, axis_table(control), "action", value);
}

void WheelInput::feel(Wheel& wheel, const WheelCall& call) {
    // Smallest changes that an operator notices, within the limits of WheelProfile.
    constexpr double steps_factor = 1.1, dead_zone_step = 0.02, curve_step = 0.1;
    constexpr double most_dead_zone = 0.9, least_curve = 0.2, most_curve = 5;
    constexpr double least_steps = 0.001, most_steps_factor = 1000;
    const JogControl& control = wheel.controls[wheel.selected];
    if (control.kind == JogKind::button)
        fail("{} is a button: it has no way to feel", control.name);
    if (!wheel.profile->axes.contains(control.name)) assign(wheel, does_nothing);
    const AxisMap map = wheel.profile->axes.at(control.name);
    const auto set_number = [&](const char* key, double value) {
        set(wheel, axis_table(control), key, fmt::format("{:.3f}", value));
    };
    if (call.action == WheelCall::Action::invert)
        return set(wheel, axis_table(control), "inverted", map.inverted ? "false" : "true");
    if (call.action == WheelCall::Action::steps)
        return set_number("sensitivity",
                          std::clamp(map.sensitivity * std::pow(steps_factor, call.amount),
                                     least_steps, most_steps_factor));
    if (control.kind == JogKind::step)
        fail("{} turns without a rest: it has no dead zone and no curve", control.name);
    if (call.action == WheelCall::Action::dead_zone)
        set_number("dead_zone",
                   std::clamp(map.dead_zone + dead_zone_step * call.amount, 0.0, most_dead_zone));
    else
        set_number("curve",
                   std::clamp(map.curve + curve_step * call.amount, least_curve, most_curve));
}

std::string WheelInput::save(Wheel& wheel) {
    const std::filesystem::path file = saved_file_of(*wheel.profile);
    if (std::filesystem::exists(file) &&
        (is_packaged(*wheel.profile) ||
         read_text_file(file, max_wheel_file_bytes) != wheel.saved_text))
        fail(
            "{} is there and is not what this map was read from: it is left as it is; move it "
            "away and save again",
            file.string());
    make_folder(file.parent_path());
    write_text_atomically(file, wheel.profile->text);
    auto saved = std::make_shared<WheelProfile>(*wheel.profile);
    saved->file = file;
    saved->is_built_in = false;
    wheel.saved_text = saved->text;
    wheel.profile = std::move(saved);
    log_info("the map of {} is saved in {}", wheel.profile->name, file.string());
    return "saved in " + file.string();
}

std::optional<WheelMapView> WheelInput::view(MonotonicTime now) const {
    const std::lock_guard lock(mutex_);
    if (!is_open_) return std::nullopt;
    WheelMapView view;
    view.remark = remark_;
    const auto found = wheels_.find(in_hand_);
    if (found == wheels_.end()) return view;
    const Wheel& wheel = found->second;
    view.name = wheel.profile->name;
    view.file = saved_file_of(*wheel.profile).string();
    view.is_changed = wheel.profile->text != wheel.saved_text;
    view.selected = wheel.selected;
    for (const JogControl& control : wheel.controls) {
        const auto at = wheel.at.find(control.name);
        const double value = at == wheel.at.end() ? 0 : at->second;
        view.controls.push_back({control, action_of(*wheel.profile, control),
                                 control.kind != JogKind::step && value != 0, value});
    }
    if (wheel.selected < wheel.controls.size())
        if (const auto map = wheel.profile->axes.find(wheel.controls[wheel.selected].name);
            map != wheel.profile->axes.end())
            view.feel = map->second;
    if (now - wheel.turned_at < turn_shown) view.turned = wheel.turned;
    return view;
}

std::vector<std::string> WheelInput::unsaved() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> names;
    for (const auto& [devices, wheel] : wheels_)
        if (wheel.profile->text != wheel.saved_text) names.push_back(wheel.profile->name);
    return names;
}

}  // namespace vantage
