#pragma once

#include <filesystem>

namespace vantage {

/// Cuts off what a failure left of a fragment behind the last whole one of a fragmented MP4 file:
/// players stumble over half a picture. Throws Error if the file cannot be read or cut.
void cut_to_whole_fragments(const std::filesystem::path& path);

}  // namespace vantage
