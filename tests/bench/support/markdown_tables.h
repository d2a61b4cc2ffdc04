#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// Replaces what stands between the lines `<!-- measured: begin -->` and `<!-- measured: end -->`
/// of a Markdown file. Throws Error if the file cannot be read or lacks the lines.
void put_between_markers(const std::filesystem::path& file, const std::string& tables);

}  // namespace vantage
