#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace vantage {

/// One sentence on words that a program's parser did not take, with `complaint` as its word: names
/// a command or an option that does not exist and the nearest that does, and the help of the
/// command that the words lead to.
std::string misfit_sentence(const CLI::App& program, const std::vector<std::string>& words,
                            const std::string& complaint);

/// The same where a word stands for no command, whatever else is right; empty: all do.
std::string unknown_command_sentence(const CLI::App& program,
                                     const std::vector<std::string>& words);

}  // namespace vantage
