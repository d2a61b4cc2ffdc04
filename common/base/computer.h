#pragma once

#include <cstddef>
#include <string>

namespace vantage {

/// This computer in a line: system, kernel, architecture, processors, memory. Not its name.
std::string computer_words();

/// Raises this process's limit of open files as far as it may go. Throws Error, naming `what`, the
/// limit and the mend, if fewer than `needed` more can be opened then.
void require_descriptors(std::size_t needed, const std::string& what);

}  // namespace vantage
