#pragma once

#include <filesystem>

namespace vantage {

/// Checks that an image can be saved to the path, before the flight whose result it is. Throws
/// Error for a wrong extension, for a folder that is missing or not writable, and for an existing
/// file that may not be replaced.
void require_picture_target(const std::filesystem::path& path, bool may_replace);

}  // namespace vantage
