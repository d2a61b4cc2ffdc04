#pragma once

#include <functional>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace vantage {

/// A subcommand of a program. `add` declares its options on the parser and sets a callback that
/// does the work. The callback throws Error for faults that the user, a file or a device caused.
struct CommandEntry {
    std::function<void(CLI::App& program)> add;
};

/// The name and description of a program, for --help and --version.
struct ProgramFacts {
    std::string_view name, description;
    std::string_view commit{};     ///< of the sources; empty: unknown
    std::string_view libraries{};  ///< "ZeroMQ 4.3.4, OpenCV 4.6.0"; empty: not printed
    /// Return large freed blocks to the system at once. For programs that allocate and free large
    /// blocks beside small long-lived ones for hours. It costs a page fault per 4 KiB of each
    /// block.
    bool returns_large_blocks = false;
};

/// Parses the command line and runs the command. Results go to stdout, the log to stderr. Returns
/// the exit status: 0 for success; 1 after one clear sentence on stderr; 2 for a command line that
/// cannot be parsed; 3 for a result that the input does not decide (Undecided); 130 after Ctrl-C.
/// `help COMMAND` equals `COMMAND --help`. The hidden options --man-page and --bash-completion
/// print the files that the packages install beside the program.
int run_program(const ProgramFacts& facts, const std::vector<CommandEntry>& commands, int argc,
                char** argv);

}  // namespace vantage
