#pragma once

#include <string_view>

namespace vantage {

/// The chroma subsampling of a JPEG: none, horizontal, or horizontal and vertical. A Bayer sensor
/// has no more chroma resolution than the last.
enum class Chroma { full, half, quarter };

/// The usual notation: "4:4:4", "4:2:2", "4:2:0".
std::string_view name_of(Chroma chroma);

/// Throws Error with the known names.
Chroma parse_chroma(std::string_view name);

}  // namespace vantage
