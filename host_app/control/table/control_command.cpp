#include "host_app/control/table/control_command.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <set>

#include <fmt/format.h>

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/toml_edit.h"

namespace vantage {
namespace {

using Argument = CommandArgument;

}  // namespace

std::span<const ControlCommand> control_commands() {
    static const std::vector<ControlCommand> all = [] {
        std::vector<ControlCommand> both;
        for (const auto part : {replay_commands(), show_commands()})
            both.insert(both.end(), part.begin(), part.end());
        return both;
    }();
    return all;
}

const ControlCommand* find_command(std::string_view name) {
    for (const ControlCommand& command : control_commands()) {
        if (name == command.name) return &command;
        if (name.empty() || name != command.old_name) continue;
        warn_of_old_name(name, command.name);
        return &command;
    }
    return nullptr;
}

void warn_of_old_name(std::string_view old_name, std::string_view name) {
    static std::mutex mutex;
    static std::set<std::string, std::less<>> warned;
    const std::lock_guard lock(mutex);
    if (warned.emplace(old_name).second)
        log_warning("'{}' is an old name and will stop working: use '{}'", old_name, name);
}

void apply(const CommandCall& call, FlightInput& input) {
    const CommandAmount& amount = call.command->amount;
    if (amount.of)
        input.*amount.of += call.argument * amount.per_step;
    else if (call.command->make_of_words)
        input.commands.push_back(call.command->make_of_words(call.words));
    else
        input.commands.push_back(call.command->make(call.argument));
}

std::optional<CommandCall> call_of(const ControlCommand& command, std::optional<double> argument) {
    const double value = argument.value_or(0);
    switch (command.argument) {
        case Argument::none:
            if (argument) return std::nullopt;
            break;
        case Argument::number:
            if (!(value >= 1 && value <= command.max_number && value == std::floor(value)))
                return std::nullopt;
            break;
        case Argument::words:
            return std::nullopt;
        case Argument::steps:
            if (!argument || !(std::abs(value) <= most_steps)) return std::nullopt;
            break;
    }
    return CommandCall{&command, value, {}};
}

std::optional<CommandCall> call_of(const ControlCommand& command, const std::string& words) {
    if (command.argument != Argument::words || words.empty() || !fault_of_name(words).empty())
        return std::nullopt;
    return CommandCall{&command, 0, words};
}

std::optional<CommandCall> parse_button_command(std::string_view text) {
    const std::size_t space = text.find(' ');
    const ControlCommand* command = find_command(text.substr(0, space));
    if (!command || command->argument == Argument::steps || command->argument == Argument::words)
        return std::nullopt;
    if (space == std::string_view::npos) return call_of(*command, std::nullopt);
    int number = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data() + space + 1, last, number);
    if (error != std::errc() || end != last) return std::nullopt;
    return call_of(*command, number);
}

CommandCall parse_typed_command(std::string_view text) {
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    // A time alone is the argument of cue_time.
    constexpr std::string_view of_times = "-.0123456789";
    if (!text.empty() && of_times.find(text.front()) != std::string_view::npos)
        if (auto call = call_of(*find_command("cue_time"), std::string(text))) return *call;
    const std::size_t space = text.find(' ');
    const std::string name(text.substr(0, space));
    const ControlCommand* command = find_command(name);
    if (!command) {
        std::vector<std::string> names;
        for (const ControlCommand& each : control_commands()) names.emplace_back(each.name);
        const std::string nearest = nearest_name(name, names);
        fail("there is no command '{}'; {}", name,
             nearest.empty() ? "vantage control lists all commands"
                             : "did you mean " + nearest + "?");
    }
    std::string argument(space == std::string_view::npos ? "" : text.substr(space + 1));
    std::optional<CommandCall> call;
    double number = 0;
    const char* last = argument.data() + argument.size();
    if (command->argument == Argument::words)
        call = call_of(*command, argument);
    else if (argument.empty())
        call = call_of(*command, std::nullopt);
    else if (const auto [end, error] = std::from_chars(argument.data(), last, number);
             error == std::errc() && end == last)
        call = call_of(*command, number);
    if (!call)
        fail("'{}' has an argument that does not fit: {}{}", text, name, argument_words(*command));
    return *call;
}

std::string argument_words(const ControlCommand& command) {
    switch (command.argument) {
        case Argument::none:
            break;
        case Argument::number:
            return fmt::format(" {} (1 to {})", command.argument_name, command.max_number);
        case Argument::steps:
            return " STEPS";
        case Argument::words:
            return fmt::format(" {}", command.argument_name);
    }
    return "";
}

std::vector<std::string> button_commands() {
    std::vector<std::string> all;
    for (const ControlCommand& command : control_commands()) {
        if (command.argument == Argument::none) all.emplace_back(command.name);
        if (command.argument != Argument::number) continue;
        // Longer ranges are represented by their first number.
        constexpr int few = 9;
        for (int n = 1; n <= (command.max_number > few ? 1 : command.max_number); ++n)
            all.push_back(fmt::format("{} {}", command.name, n));
    }
    return all;
}

std::string key_words(const ControlCommand& command) {
    const std::string_view key = command.key.name;
    if (key.empty()) return "";
    std::string words = fmt::format("{}{}", command.key.with_control ? "Ctrl + " : "", key);
    if (command.argument != Argument::number || command.max_number > 9) return words;
    const bool is_function = key.size() > 1;
    const int first = std::atoi(key.data() + (is_function ? 1 : 0));
    return fmt::format("{} .. {}{}", words, is_function ? "F" : "", first + command.max_number - 1);
}

}  // namespace vantage
