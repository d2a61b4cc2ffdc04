#pragma once

#include <string>

namespace vantage {

/// One line about this computer: system, kernel, architecture, processors and memory, without its
/// host name.
std::string computer_words();

}  // namespace vantage
