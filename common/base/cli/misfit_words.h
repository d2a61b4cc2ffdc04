#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace vantage {

/// One sentence about a command line that the parser refused with `complaint`. It names the unknown
/// command or option, the nearest known one, and the --help of the command in question.
std::string misfit_sentence(const CLI::App& program, const std::vector<std::string>& words,
                            const std::string& complaint);

/// One sentence about an argument that names no command; empty if all commands are known.
std::string unknown_command_sentence(const CLI::App& program,
                                     const std::vector<std::string>& words);

}  // namespace vantage
