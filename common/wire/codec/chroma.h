#pragma once

#include <string_view>

namespace vantage {

/// How finely a JPEG has what tells its colours from grey: of every pixel, of two beside each
/// other, of four in a square. A Bayer sensor sees no more of it than the last.
enum class Chroma { full, half, quarter };

/// As people write them: "4:4:4", "4:2:2", "4:2:0".
std::string_view name_of(Chroma chroma);

/// Throws Error naming those that there are.
Chroma parse_chroma(std::string_view name);

}  // namespace vantage
