#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "host_app/background/background.h"

namespace vantage {

// A background file: a line that names the format, then a message of background.proto.

inline constexpr const char* background_file_extension = ".vset";

std::vector<std::byte> encode_background(const Background& background);
/// Throws Error if the bytes are no complete background of this version, before it allocates the
/// memory that they ask for.
Background decode_background(std::span<const std::byte> bytes);

/// Throws Error with the path if the file is missing, unreadable, damaged or no background file.
Background load_background(const std::filesystem::path& path);
/// Writes the file completely or not at all. Throws Error with the path and the system's reason.
void save_background(const Background& background, const std::filesystem::path& path);

}  // namespace vantage
