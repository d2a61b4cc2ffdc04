#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Writes a temporary file beside the target, syncs it and renames it over the target, so that an
/// existing file stays either untouched or complete. Throws Error with the path and the reason.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Reads a whole file. Throws Error if it is missing, unreadable or larger than max_bytes.
std::vector<std::byte> read_file(const std::filesystem::path& path, std::size_t max_bytes);

// The same for text.
void write_text_atomically(const std::filesystem::path& path, std::string_view text);
std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Waits until the data written to a file is on disk. Returns 0, also where the file system cannot
/// tell, or errno. The kernel reports a write error only once: a caller that ignores it loses data
/// silently, since write() may keep succeeding after the disk is gone.
int sync_data(int fd);

}  // namespace vantage
