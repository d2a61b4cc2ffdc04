#pragma once

#include <filesystem>
#include <vector>

#include "calib_tools/board/board_pattern.h"

namespace vantage {

/// A board's description (TOML, version 1): kind, columns, rows, square_m, and for ChArUco
/// marker_m, dictionary, first_marker and, where it is true, legacy. Both throw Error; unknown keys
/// are refused, and a body of several boards too.
BoardPattern load_board(const std::filesystem::path& path);
void save_board(const std::filesystem::path& path, const BoardPattern& pattern);

/// A body of boards that are fixed to each other, such as a cube: as a ChArUco board's description,
/// with `first_markers`, the first marker of every face, in place of first_marker. A single board
/// is a body of one. Both throw Error; what is saved are faces that differ by their markers only.
std::vector<BoardPattern> load_body(const std::filesystem::path& path);
void save_body(const std::filesystem::path& path, const std::vector<BoardPattern>& faces);

}  // namespace vantage
