#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage {

/// The last line that a program of Vantage wrote to this file, without the name of the program and
/// the level before it: the sentence that it ended with. Empty where the file has none.
std::string last_sentence_of(const std::filesystem::path& log);

/// The warnings that a program of Vantage wrote to this file, without what stands before them.
std::vector<std::string> warnings_in(const std::filesystem::path& log);

}  // namespace vantage
