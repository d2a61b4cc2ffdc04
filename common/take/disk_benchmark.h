#pragma once

#include <filesystem>

namespace vantage {

/// How many megabytes a second the disk of this folder takes, until they are on it: measured by
/// writing some, for a third of a second at most. Throws Error if nothing can be written there.
double measure_disk_mb_s(const std::filesystem::path& folder);

/// Megabytes that are free there.
double free_disk_mb(const std::filesystem::path& folder);

}  // namespace vantage
