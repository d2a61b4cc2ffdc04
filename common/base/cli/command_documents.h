#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace vantage {

/// The program's manual page (section 1, roff) with every command and its options, generated from
/// the parser's tables.
std::string man_page(const CLI::App& program, std::string_view version);

/// A bash completion script for the program's commands and options. It completes the values that an
/// option's type lists in braces, and file names for other values.
std::string bash_completion(const CLI::App& program);

}  // namespace vantage
