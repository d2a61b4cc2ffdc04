#include "host_app/control/table/control_command.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <fmt/format.h>

namespace vantage {
namespace {

using Argument = CommandArgument;
using Input = FlightInput;

constexpr double deg = std::numbers::pi / 180;
constexpr int shots = 9, outputs = 8;

constexpr ControlCommand commands[] = {
    {.name = "live",
     .does = "back to live; of a take: normal speed",
     .lamp = "live",
     .key = {"L"},
     .apply = [](Input& input, double) { input.to_live = true; }},
    {.name = "freeze",
     .does = "freeze the instant and fly on; in the past: stop, play on",
     .lamp = "hold",
     .key = {"Space"},
     .apply = [](Input& input, double) { input.toggle_freeze = !input.toggle_freeze; }},
    {.name = "frame_back",
     .does = "a frame back, through what is kept of the past",
     .lamp = "behind",
     .key = {.name = ",", .repeats = true},
     .apply = [](Input& input, double) { input.past_steps -= 1; }},
    {.name = "frame_on",
     .does = "a frame on",
     .lamp = "behind",
     .key = {.name = ".", .repeats = true},
     .apply = [](Input& input, double) { input.past_steps += 1; }},
    {.name = "slower",
     .does = "play the past slower, down to twice backwards",
     .lamp = "speed",
     .key = {.name = "[", .repeats = true},
     .apply = [](Input& input, double) { --input.speed_steps; }},
    {.name = "faster",
     .does = "play the past faster, up to twice on",
     .lamp = "speed",
     .key = {.name = "]", .repeats = true},
     .apply = [](Input& input, double) { ++input.speed_steps; }},
    {.name = "mark_in",
     .does = "mark in",
     .lamp = "mark_in",
     .key = {"I"},
     .apply = [](Input& input, double) { input.mark_in = true; }},
    {.name = "mark_out",
     .does = "mark out, the first frame that is left out",
     .lamp = "mark_out",
     .key = {"O"},
     .apply = [](Input& input, double) { input.mark_out = true; }},
    {.name = "no_marks",
     .does = "no marks",
     .lamp = "mark_in",
     .key = {"U"},
     .apply = [](Input& input, double) { input.clear_marks = true; }},
    {.name = "loop",
     .does = "loop between the marks, or no more",
     .lamp = "loop",
     .key = {"B"},
     .apply = [](Input& input, double) { input.toggle_loop = !input.toggle_loop; }},
    {.name = "cue",
     .does = "to the in mark",
     .lamp = "behind",
     .key = {"Home"},
     .apply = [](Input& input, double) { input.cue = true; }},
    {.name = "shot",
     .argument = Argument::number,
     .most = shots,
     .does = "fly to a shot (at first: what that rig sees)",
     .key = {"1"},
     .apply = [](Input& input, double n) { input.recall_shot = static_cast<int>(n); }},
    {.name = "store",
     .argument = Argument::number,
     .most = shots,
     .does = "keep this view as a shot",
     .key = {.name = "1", .with_control = true},
     .apply = [](Input& input, double n) { input.store_shot = static_cast<int>(n); }},
    {.name = "reset",
     .does = "back to the start",
     .key = {"R"},
     .apply = [](Input& input, double) { input.reset = true; }},
    {.name = "play",
     .does = "play or leave the planned move",
     .lamp = "move",
     .key = {"P"},
     .apply = [](Input& input, double) { input.toggle_move = !input.toggle_move; }},
    {.name = "add_keyframe",
     .does = "put this view behind the end of the move",
     .lamp = "keyframes",
     .key = {"K"},
     .apply = [](Input& input, double) { input.add_keyframe = true; }},
    {.name = "set_keyframe",
     .does = "put this view where the move stands",
     .lamp = "keyframes",
     .key = {.name = "K", .with_control = true},
     .apply = [](Input& input, double) { input.set_keyframe = true; }},
    {.name = "remove_keyframe",
     .does = "take out the keyframe nearest to where the move stands",
     .lamp = "keyframes",
     .key = {"X"},
     .apply = [](Input& input, double) { input.remove_keyframe = true; }},
    {.name = "keyframe_back",
     .does = "along the move to the keyframe before",
     .lamp = "move",
     .key = {"F3"},
     .apply = [](Input& input, double) { --input.keyframe_jump; }},
    {.name = "keyframe_on",
     .does = "along the move to the next keyframe",
     .lamp = "move",
     .key = {"F4"},
     .apply = [](Input& input, double) { ++input.keyframe_jump; }},
    {.name = "record",
     .does = "record a flight by hand as the move, or end that",
     .lamp = "record",
     .key = {"G"},
     .apply = [](Input& input, double) { input.toggle_recording = !input.toggle_recording; }},
    {.name = "horizon",
     .does = "hold the horizon level, or let it roll",
     .lamp = "horizon",
     .key = {"H"},
     .apply = [](Input& input, double) { input.toggle_horizon = !input.toggle_horizon; }},
    {.name = "pivot",
     .does = "put the pivot on what is in the middle of the picture",
     .key = {"V"},
     .apply = [](Input& input, double) { input.pick = Eigen::Vector2d(0.5, 0.5); }},
    {.name = "follow",
     .does = "let the pivot go with the performer who is there, or no more",
     .lamp = "follow",
     .key = {"F"},
     .apply = [](Input& input, double) { input.toggle_follow = !input.toggle_follow; }},
    {.name = "mode",
     .does = "wheels drive the next of orbit, move, past",
     .lamp = "wheel",
     .key = {"M"},
     .apply = [](Input& input, double) { input.next_wheel_mode = true; }},
    {.name = "tracking",
     .does = "let the tracked camera fly, or no more",
     .lamp = "tracking",
     .key = {"C"},
     .apply = [](Input& input, double) { input.toggle_tracking = !input.toggle_tracking; }},
    {.name = "take",
     .does = "begin or end a take of what the rigs send",
     .lamp = "take",
     .key = {"T"},
     .apply = [](Input& input, double) { input.toggle_take = !input.toggle_take; }},
    {.name = "learn_set",
     .does = "the stage is empty now: learn the set anew",
     .lamp = "set",
     .key = {.name = "J", .with_control = true},
     .apply = [](Input& input, double) { input.learn_set = true; }},
    {.name = "save_set",
     .does = "save what is known of the set",
     .lamp = "saved_set",
     .key = {"J"},
     .apply = [](Input& input, double) { input.save_set = true; }},
    {.name = "output",
     .argument = Argument::number,
     .most = outputs,
     .does = "begin an output; given twice, end it",
     .lamp = "output",
     .key = {"F5"},
     .apply = [](Input& input, double n) { input.toggle_output = static_cast<int>(n); }},
    {.name = "synthesiser",
     .does = "next synthesiser",
     .lamp = "synthesiser",
     .key = {"F2"},
     .apply = [](Input& input, double) { input.next_synthesiser = true; }},
    {.name = "source_map",
     .does = "show which rig each pixel comes from",
     .lamp = "source_map",
     .key = {"N"},
     .apply = [](Input& input, double) { input.toggle_novelty = !input.toggle_novelty; }},
    {.name = "wheel",
     .argument = Argument::steps,
     .does = "turn what the mode says: orbit, move or past",
     .amount = {&Input::wheel_steps, 1, 30}},
    {.name = "retime",
     .argument = Argument::steps,
     .does = "the keyframe where the move stands, and all behind it, later; a step is 0.1 s",
     .amount = {&Input::retime_s, 0.1, 2}},
    {.name = "orbit",
     .argument = Argument::steps,
     .does = "around the pivot, to the right; a step is a degree",
     .amount = {&Input::orbit_azimuth_rad, 1 * deg, 60 * deg}},
    {.name = "elevate",
     .argument = Argument::steps,
     .does = "up around the pivot; a step is a degree",
     .amount = {&Input::orbit_elevation_rad, 1 * deg, 40 * deg}},
    {.name = "pan_right",
     .argument = Argument::steps,
     .does = "shift right; a step is a hundredth of the picture's width",
     .amount = {&Input::pan_right_widths, 0.01, 0.4}},
    {.name = "pan_up",
     .argument = Argument::steps,
     .does = "shift up; a step is a hundredth of the picture's width",
     .amount = {&Input::pan_up_widths, 0.01, 0.4}},
    {.name = "crane",
     .argument = Argument::steps,
     .does = "straight up; a step is a hundredth of the picture's width",
     .amount = {&Input::crane_up_widths, 0.01, 0.4}},
    {.name = "look_right",
     .argument = Argument::steps,
     .does = "turn to the right where the camera stands; a step is a degree",
     .amount = {&Input::look_right_rad, 1 * deg, 40 * deg}},
    {.name = "look_up",
     .argument = Argument::steps,
     .does = "turn up where the camera stands; a step is a degree",
     .amount = {&Input::look_up_rad, 1 * deg, 40 * deg}},
    {.name = "roll",
     .argument = Argument::steps,
     .does = "clockwise about the line of sight, unless the horizon is held; a step is a degree",
     .amount = {&Input::roll_rad, 1 * deg, 40 * deg}},
    {.name = "dolly",
     .argument = Argument::steps,
     .does = "nearer; a step is two hundredths of the distance",
     .amount = {&Input::dolly, 0.02, 0.8}},
    {.name = "zoom",
     .argument = Argument::steps,
     .does = "narrower; a step is two hundredths of the angle",
     .amount = {&Input::zoom, 0.02, 0.6}}};

}  // namespace

std::span<const ControlCommand> control_commands() { return commands; }

const ControlCommand* find_command(std::string_view name) {
    for (const ControlCommand& command : commands)
        if (name == command.name) return &command;
    return nullptr;
}

void apply(const CommandCall& call, FlightInput& input) {
    const CommandAmount& amount = call.command->amount;
    if (amount.of)
        input.*amount.of += call.argument * amount.per_step;
    else
        call.command->apply(input, call.argument);
}

std::optional<CommandCall> call_of(const ControlCommand& command, std::optional<double> argument) {
    const double value = argument.value_or(0);
    switch (command.argument) {
        case Argument::none:
            if (argument) return std::nullopt;
            break;
        case Argument::number:
            if (!(value >= 1 && value <= command.most && value == std::floor(value)))
                return std::nullopt;
            break;
        case Argument::steps:
            if (!argument || !(std::abs(value) <= most_steps)) return std::nullopt;
            break;
    }
    return CommandCall{&command, value};
}

std::optional<CommandCall> parse_button_command(std::string_view text) {
    const std::size_t space = text.find(' ');
    const ControlCommand* command = find_command(text.substr(0, space));
    if (!command || command->argument == Argument::steps) return std::nullopt;
    if (space == std::string_view::npos) return call_of(*command, std::nullopt);
    int number = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data() + space + 1, last, number);
    if (error != std::errc() || end != last) return std::nullopt;
    return call_of(*command, number);
}

std::vector<std::string> button_commands() {
    std::vector<std::string> all;
    for (const ControlCommand& command : commands) {
        if (command.argument == Argument::none) all.emplace_back(command.name);
        for (int n = 1; command.argument == Argument::number && n <= command.most; ++n)
            all.push_back(fmt::format("{} {}", command.name, n));
    }
    return all;
}

std::string key_words(const ControlCommand& command) {
    const std::string_view key = command.key.name;
    if (key.empty()) return "";
    std::string words = fmt::format("{}{}", command.key.with_control ? "Ctrl + " : "", key);
    if (command.argument != Argument::number) return words;
    const bool is_function = key.size() > 1;
    const int first = std::atoi(key.data() + (is_function ? 1 : 0));
    return fmt::format("{} .. {}{}", words, is_function ? "F" : "", first + command.most - 1);
}

}  // namespace vantage
