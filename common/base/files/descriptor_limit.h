#pragma once

#include <cstddef>
#include <string>

namespace vantage {

/// Raises the limit of open files of this process to its hard limit. Throws Error, naming `what`,
/// the limit and the mend, if fewer than `needed` more files can be opened then.
void require_descriptors(std::size_t needed, const std::string& what);

}  // namespace vantage
