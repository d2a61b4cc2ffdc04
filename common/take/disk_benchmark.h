#pragma once

#include <filesystem>

namespace vantage {

/// Measures the write rate of a folder's disk in MB/s, including the sync, by writing for at most
/// 0.3 s. Throws Error if the folder is not writable.
double measure_disk_mb_s(const std::filesystem::path& folder);

/// Free space on the folder's disk in MB.
double free_disk_mb(const std::filesystem::path& folder);

}  // namespace vantage
