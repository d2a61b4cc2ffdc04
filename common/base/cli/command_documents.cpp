#include "common/base/cli/command_documents.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/base/cli/nearest_name.h"

namespace vantage {
namespace {

/// Visits the app and every subcommand below it, with the command line that leads there ("rigs
/// status").
void visit(const CLI::App& app, const std::string& words,
           const std::function<void(const CLI::App&, const std::string&)>& action) {
    action(app, words);
    for (const CLI::App* command : commands_of(app))
        visit(*command, words.empty() ? command->get_name() : words + " " + command->get_name(),
              action);
}

/// Escapes plain text for roff: no line is taken as a roff request, and '-' stays a hyphen that can
/// be copied from the page.
std::string roff(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        if (escaped.empty() || escaped.back() == '\n') {
            if (c == '.' || c == '\'') escaped += "\\&";
        }
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";
        else
            escaped += c;
    }
    return escaped;
}

std::string roff_option(const CLI::Option& option) {
    std::string value = option.get_type_name();
    if (!value.empty() && option.get_items_expected_max() > 0) value = " " + value;
    const std::string names =
        option.get_positional() ? option.get_name(true) : option.get_name(false, true);
    return fmt::format(".TP\n.B {}\n{}{}\n", roff(names + value), roff(option.get_description()),
                       option.get_required() ? " (required)" : "");
}

std::string roff_options(const CLI::App& app) {
    std::string text;
    for (const CLI::Option* option : options_of(app))
        if (!option->get_group().empty()) text += roff_option(*option);
    return text;
}

/// The values that an option's type lists in braces: "{auto,best}".
std::vector<std::string> words_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    std::vector<std::string> words;
    for (std::size_t open = type.find('{'); open != std::string::npos;
         open = type.find('{', open)) {
        const std::size_t close = std::min(type.find('}', open), type.size());
        for (std::size_t at = ++open; at < close;) {
            const std::size_t end = std::min(type.find(',', at), close);
            words.push_back(type.substr(at, end - at));
            at = end + 1;
        }
    }
    return words;
}

}  // namespace

std::string man_page(const CLI::App& program, std::string_view version) {
    const std::string& name = program.get_name();
    std::string title = name;
    std::transform(title.begin(), title.end(), title.begin(), ::toupper);
    std::string text = fmt::format(
        ".TH {} 1 \"\" \"{} {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.B {}\n"
        "COMMAND [OPTIONS]\n",
        roff(title), roff(name), roff(version), roff(name), roff(program.get_description()),
        roff(name));
    visit(program, "", [&](const CLI::App& app, const std::string& words) {
        if (words.empty()) {
            text += ".SH OPTIONS\n" + roff_options(app) + ".SH COMMANDS\n";
            return;
        }
        text +=
            fmt::format(".SS {} {}\n{}\n", roff(name), roff(words), roff(app.get_description()));
        if (commands_of(app).empty()) text += roff_options(app);
    });
    return text +
           ".SH EXIT STATUS\n0: success. 1: a file, a device or the network caused a fault, or a "
           "check failed; a sentence says which. 2: the command line cannot be parsed. 3: the "
           "input does not decide the question. 130: ended by Ctrl\\-C.\n";
}

std::string bash_completion(const CLI::App& program) {
    const std::string& name = program.get_name();
    std::string function = "_" + name;
    std::replace(function.begin(), function.end(), '-', '_');
    std::string places, words_of_places, values_of_options;
    visit(program, "", [&](const CLI::App& app, const std::string& words) {
        if (!words.empty()) places += fmt::format("{}'{}'", places.empty() ? "" : " | ", words);
        std::vector<std::string> commands, options;
        for (const CLI::App* command : commands_of(app)) commands.push_back(command->get_name());
        for (const CLI::Option* option : options_of(app)) {
            if (option->get_group().empty()) continue;  // hidden, such as the old name of another
            for (const std::string& option_name : option->get_lnames()) {
                options.push_back("--" + option_name);
                if (const std::vector<std::string> values = words_of(*option); !values.empty())
                    values_of_options += fmt::format("    '{} --{}') values='{}' ;;\n", words,
                                                     option_name, fmt::join(values, " "));
            }
        }
        words_of_places += fmt::format("    '{}') commands='{}' options='{}' ;;\n", words,
                                       fmt::join(commands, " "), fmt::join(options, " "));
    });
    return fmt::format(
        R"(# Completes {0} in bash: commands, options, and files elsewhere. Made by: {0} --bash-completion
{1}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} place= commands= options= values= i next
  for ((i = 1; i < COMP_CWORD; ++i)); do
    next=${{place:+$place }}${{COMP_WORDS[i]}}
    case $next in
      {2}) place=$next ;;
    esac
  done
  case $place in
{3}  esac
  case "$place ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{4}    *) ;;
  esac
  case ${{values:+values}}$word in
    values*) mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word") ;;
    -*) mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word") ;;
    *) mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$word") ;;
  esac
}}
complete -o default -F {1} {0}
)",
        name, function, places, words_of_places, values_of_options);
}

namespace {

/// CLI11 keeps an option group as a subcommand without a name.
bool is_group(const CLI::App* app) { return app->get_name().empty(); }

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App* command) { return !is_group(command); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
    std::vector<const CLI::Option*> options = app.get_options({});
    for (const CLI::App* group : app.get_subcommands(is_group))
        for (const CLI::Option* option : group->get_options({}))
            if (option != group->get_help_ptr()) options.push_back(option);
    return options;
}

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
