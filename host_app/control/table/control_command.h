#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host_app/flight/flight_input.h"

namespace vantage {

/// What stands behind a command's name.
enum class CommandArgument {
    none,
    number,  ///< 1 to `most`
    steps,   ///< detents of a jog wheel, either way
    words,   ///< of a person, 40 bytes at most
};

/// The document that has a command or a lamp in its tables.
enum class ControlPage { control, replay };

/// The key of the keyboard that gives a command: a letter, a digit, a sign, or Space, Home, End,
/// Insert, Delete, PgUp, PgDn, Backspace, F1 to F12. Of a command with a number it is that of
/// number 1, and the keys after it go on.
struct CommandKey {
    const char* name = "";  ///< empty: none
    bool with_control = false;
    bool repeats = false;  ///< held, it goes on
};

/// What turning a control by a detent does, and holding it at the end of its way for a second.
struct CommandAmount {
    double FlightInput::*of = nullptr;
    double per_step = 0, per_second = 0;
};

/// Something that an operator can ask for, whatever the hand: keys, jog maps and OSC are views
/// of the one table of these.
struct ControlCommand {
    const char* name;
    ControlPage page = ControlPage::control;
    CommandArgument argument = CommandArgument::none;
    const char* argument_name = "N";  ///< of a number or words, for people
    int most = 0;                     ///< of a number
    const char* does;
    const char* lamp = "";  ///< that shows what came of it; empty: the picture does
    CommandKey key = {};
    CommandAmount amount = {};
    void (*apply)(FlightInput& input, double argument) = nullptr;  ///< unless it has an amount
    void (*apply_words)(FlightInput& input, const std::string& words) = nullptr;  ///< of words
};

/// All of them, in the order in which people are shown them.
std::span<const ControlCommand> control_commands();
/// Null: there is none of this name.
const ControlCommand* find_command(std::string_view name);

/// A command with its argument, which fits.
struct CommandCall {
    const ControlCommand* command = nullptr;
    double argument = 0;
    std::string words = {};
};
void apply(const CommandCall& call, FlightInput& input);

/// Larger turns at once are no hand's.
constexpr double most_steps = 360;
/// Nothing: the argument does not fit the command.
std::optional<CommandCall> call_of(const ControlCommand& command, std::optional<double> argument);
std::optional<CommandCall> call_of(const ControlCommand& command, const std::string& words);

/// "live", "shot 3": what a jog map has for a button. Nothing: there is no such command.
std::optional<CommandCall> parse_button_command(std::string_view text);
/// All that parse_button_command() takes.
std::vector<std::string> button_commands();

/// What a person has typed: "clip_speed 50", or a time alone for cue_time. Throws Error for what is
/// no command or does not fit one.
CommandCall parse_typed_command(std::string_view text);

/// " N (1 to 9)", " STEPS": what stands behind the name, for people.
std::string argument_words(const ControlCommand& command);

/// "Ctrl + 1 .. 9", for people; empty: no key gives it.
std::string key_words(const ControlCommand& command);

}  // namespace vantage
