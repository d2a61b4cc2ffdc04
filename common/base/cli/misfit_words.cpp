#include "common/base/cli/misfit_words.h"

#include <algorithm>
#include <cctype>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/base/cli/command_tree.h"
#include "common/base/cli/nearest_name.h"

namespace vantage {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
    return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : options_of(app))
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// The command that the arguments name.
struct Place {
    const CLI::App* command;
    std::string name;            ///< "vantage rigs status"
    std::string unknown;         ///< an argument where a command's name is expected
    std::size_t words_used = 0;  ///< number of arguments up to the command's name
};

Place place_of(const CLI::App& program, const std::vector<std::string>& words) {
    Place place{.command = &program, .name = program.get_name(), .unknown = ""};
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::vector<const CLI::App*> commands = commands_of(*place.command);
        if (commands.empty()) break;
        if (words[i].starts_with("-")) continue;
        const auto found = std::find_if(commands.begin(), commands.end(), [&](const CLI::App* c) {
            return c->get_name() == words[i];
        });
        if (found == commands.end()) {
            place.unknown = words[i];
            break;
        }
        place.command = *found;
        place.name += " " + words[i];
        place.words_used = i + 1;
    }
    return place;
}

/// The first argument that looks like an option and that the command does not have; empty if none.
std::string unknown_option(const Place& place, const std::vector<std::string>& words) {
    for (std::size_t i = place.words_used; i < words.size() && words[i] != "--"; ++i) {
        if (words[i].size() < 2 || words[i][0] != '-') continue;
        const bool is_long = words[i][1] == '-';
        if (!is_long && std::isalpha(static_cast<unsigned char>(words[i][1])) == 0) continue;
        std::string name = is_long ? words[i].substr(0, words[i].find('=')) : words[i].substr(0, 2);
        if (!place.command->get_option_no_throw(name)) return name;
    }
    return "";
}

}  // namespace

std::string unknown_command_sentence(const CLI::App& program,
                                     const std::vector<std::string>& words) {
    const Place place = place_of(program, words);
    if (place.unknown.empty()) return "";
        return fmt::format("{} has no command '{}'; {}; {} --help lists the commands", place.name,
                       place.unknown, suggest_name(place.unknown, command_names(*place.command)),
                       place.name);
}

std::string misfit_sentence(const CLI::App& program, const std::vector<std::string>& words,
                            const std::string& complaint) {
    if (std::string sentence = unknown_command_sentence(program, words); !sentence.empty())
        return sentence;
    const Place place = place_of(program, words);
    const std::string option = unknown_option(place, words);
    if (option.empty())
        return fmt::format("{}; {} --help lists the options", complaint, place.name);
    const std::string nearest = nearest_name(option, option_names(*place.command));
    return fmt::format("{} has no option '{}'{}; {} --help lists the options", place.name, option,
                       nearest.empty() ? "" : fmt::format("; the nearest is '{}'", nearest),
                       place.name);
}

}  // namespace vantage
