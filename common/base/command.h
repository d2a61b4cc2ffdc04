#pragma once

#include <functional>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace vantage {

/// A subcommand of one of the programs. `add` declares its options on the program's parser and sets
/// a callback that does the work; the callback throws Error for whatever the user, a file or a
/// device caused.
struct CommandEntry {
    std::function<void(CLI::App& program)> add;
};

/// Parses and runs. Results go to stdout, the log to stderr. Returns the exit status: 0, or 1 with
/// one clear sentence on stderr, or 2 for words on the command line that do not fit.
int run_program(std::string_view name, std::string_view description,
                const std::vector<CommandEntry>& commands, int argc, char** argv);

}  // namespace vantage
