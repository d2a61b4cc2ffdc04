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

/// What a program says of itself.
struct ProgramFacts {
    std::string_view name, description;
    std::string_view commit{};     ///< of the sources; empty: unknown
    std::string_view libraries{};  ///< "ZeroMQ 4.3.4, OpenCV 4.6.0"; empty: none that matter
    /// For hours large blocks of memory come and go beside small ones that stay: they are the
    /// system's again at once. That costs a page fault every 4 KiB of each.
    bool returns_large_blocks = false;
};

/// Parses and runs. Results go to stdout, the log to stderr. Returns the exit status: 0, or 1 with
/// one clear sentence on stderr, or 2 for words on the command line that do not fit, or 3 with a
/// sentence where the answer is that nothing can be told (Undecided), or 130 after Ctrl-C. `help
/// COMMAND` is COMMAND --help. Two options that nobody types, --man-page and
/// --bash-completion, print what the packages bring beside the program.
int run_program(const ProgramFacts& facts, const std::vector<CommandEntry>& commands, int argc,
                char** argv);

}  // namespace vantage
