#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace vantage {

/// The program's manual page (section 1, roff) with every command and its options, generated from
/// the parser's tables.
std::string man_page(const CLI::App& program, std::string_view version);

/// A bash completion script for the program's commands and options. It completes the values that an
/// option's type lists in braces, and file names for other values.
std::string bash_completion(const CLI::App& program);

/// The subcommands of a command, without option groups.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// The options of a command, including those in its option groups.
std::vector<const CLI::Option*> options_of(const CLI::App& app);

/// One sentence about a command line that the parser refused with `complaint`. It names the unknown
/// command or option, the nearest known one, and the --help of the command in question.
std::string misfit_sentence(const CLI::App& program, const std::vector<std::string>& words,
                            const std::string& complaint);

/// One sentence about an argument that names no command; empty if all commands are known.
std::string unknown_command_sentence(const CLI::App& program,
                                     const std::vector<std::string>& words);

}  // namespace vantage
