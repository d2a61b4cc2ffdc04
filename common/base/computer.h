#pragma once

#include <string>

namespace vantage {

/// This computer in a line: system, kernel, architecture, processors, memory. Not its name.
std::string computer_words();

}  // namespace vantage
