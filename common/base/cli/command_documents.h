#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace vantage {

/// The program's page for man(1), section 1, in roff: every command with its options, from the
/// parser's own tables.
std::string man_page(const CLI::App& program, std::string_view version);

/// A script for bash that completes the program's commands and options, the values of options
/// whose type names them in braces, and files elsewhere.
std::string bash_completion(const CLI::App& program);

}  // namespace vantage
