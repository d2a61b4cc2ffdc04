#pragma once

#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace vantage {

/// The subcommands of a command, without option groups.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// The options of a command, including those in its option groups.
std::vector<const CLI::Option*> options_of(const CLI::App& app);

}  // namespace vantage
