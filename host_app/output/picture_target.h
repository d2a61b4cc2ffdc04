#pragma once

#include <filesystem>

namespace vantage {

/// Throws Error if a picture could not be written there later: a wrong extension, or a folder that
/// is missing or closed; or it is there already and may not be replaced. So that a flight does not
/// end with nowhere to put its picture.
void require_picture_target(const std::filesystem::path& path, bool may_replace);

}  // namespace vantage
