#pragma once

#include <filesystem>

namespace vantage {

/// Makes a folder and those above it; one that is there stays as it is. Throws Error with the path
/// and the system's reason.
void make_folder(const std::filesystem::path& folder);

}  // namespace vantage
