#pragma once

#include <filesystem>

namespace vantage {

/// Removes an incomplete fragment at the end of a fragmented MP4 file, since players fail on an
/// incomplete frame. Throws Error if the file cannot be read or cut.
void cut_to_whole_fragments(const std::filesystem::path& path);

}  // namespace vantage
