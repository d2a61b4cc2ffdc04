#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host_app/flight/flight_input.h"

namespace vantage {

/// Kind of a command's argument.
enum class CommandArgument {
    none,
    number,  ///< 1 to `max_number`
    steps,   ///< detents of a jog wheel, either way
    words,   ///< text of at most 40 bytes
};

/// The document whose tables list a command or a lamp.
enum class ControlPage { control, replay };

/// Keyboard shortcut of a command: a letter, a digit, a sign, or Space, Home, End, Insert, Delete,
/// PgUp, PgDn, Backspace, F1 to F12. For a command with a number it is the key of number 1, and the
/// following keys give the following numbers.
struct CommandKey {
    const char* name = "";  ///< empty: none
    bool with_control = false;
    bool repeats = false;  ///< while the key is held
};

/// Axis of FlightInput that a command with steps moves: for each detent of a control, and for each
/// second that a spring-loaded control is held at its end.
struct CommandAmount {
    double FlightInput::*of = nullptr;
    double per_step = 0, per_second = 0;
};

/// A row of the table of commands. Keyboard, jog maps, MIDI maps, OSC and RossTalk all use this
/// table.
struct ControlCommand {
    const char* name;
    const char* old_name = "";  ///< name in earlier versions, which still works; empty: none
    ControlPage page = ControlPage::control;
    CommandArgument argument = CommandArgument::none;
    const char* argument_name = "N";  ///< of a number or words, in the documents
    int max_number = 0;
    const char* does;
    const char* lamp = "";  ///< the lamp that shows the result; empty: only the picture shows it
    CommandKey key = {};
    CommandAmount amount = {};
    Command (*make)(double argument) = nullptr;  ///< null for commands with steps or words
    Command (*make_of_words)(const std::string& words) = nullptr;
};

/// ControlCommand::make for a command without an argument.
template <class T>
Command give(double) {
    return T{};
}

/// All commands, in the order in which documents and help list them.
std::span<const ControlCommand> control_commands();
// The two parts of the table.
std::span<const ControlCommand> replay_commands();
std::span<const ControlCommand> show_commands();

/// Finds a command by its name, or by its old name with a warning. Null if there is none.
const ControlCommand* find_command(std::string_view name);
/// Logs, once for each name, that a name from an earlier version was used. Thread-safe.
void warn_of_old_name(std::string_view old_name, std::string_view name);

/// A command with a valid argument.
struct CommandCall {
    const ControlCommand* command = nullptr;
    double argument = 0;
    std::string words = {};
};
/// Adds the call to an input: to an axis, or to its commands.
void apply(const CommandCall& call, FlightInput& input);

/// Largest number of steps in one message; no operator turns a wheel further at once.
constexpr double most_steps = 360;
/// A call of a command, or nothing if the argument does not fit it.
std::optional<CommandCall> call_of(const ControlCommand& command, std::optional<double> argument);
std::optional<CommandCall> call_of(const ControlCommand& command, const std::string& words);

/// Parses the action of a button in a jog, MIDI or RossTalk map: "live", "shot 3". Empty if there
/// is no such command.
std::optional<CommandCall> parse_button_command(std::string_view text);
/// All texts that parse_button_command() accepts.
std::vector<std::string> button_commands();

/// Parses a command that an operator typed: "clip_speed 50", or a time alone for cue_time. Throws
/// Error if there is no such command or the argument does not fit.
CommandCall parse_typed_command(std::string_view text);

/// The argument in help and documents: " N (1 to 9)", " STEPS".
std::string argument_words(const ControlCommand& command);

/// The shortcut in help and documents: "Ctrl + 1 .. 9"; empty: none.
std::string key_words(const ControlCommand& command);

}  // namespace vantage
