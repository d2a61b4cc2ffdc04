#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// The version of Vantage: "0.2.0".
std::string_view version();

/// One line about this computer: system, kernel, architecture, processors and memory, without its
/// host name.
std::string computer_words();

}  // namespace vantage
