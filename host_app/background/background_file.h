#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "host_app/background/background.h"

namespace vantage {

/// A learnt set as one file: a line that names the format, then a message of learnt_set.proto.
inline constexpr const char* set_file_extension = ".vset";

std::vector<std::byte> encode_frame_set(const Background& set);
/// Throws Error for bytes that are no whole set of this version, before memory is taken for what
/// they claim.
Background decode_frame_set(std::span<const std::byte> bytes);

/// Throws Error with the path: missing, unreadable, no set, a damaged one.
Background load_set(const std::filesystem::path& path);
/// Whole or not at all. Throws Error with the path and the system's reason.
void save_background(const Background& set, const std::filesystem::path& path);

}  // namespace vantage
