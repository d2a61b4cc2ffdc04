#pragma once

#include <filesystem>
#include <vector>

#include "common/board/board_pattern.h"

namespace vantage {

/// Read and write a board's description (TOML, version 1): kind, columns, rows, square_m, and for
/// ChArUco marker_m, dictionary, first_marker and, if true, legacy. Both throw Error; unknown keys
/// and bodies of several boards are refused.
BoardPattern load_board(const std::filesystem::path& path);
void save_board(const std::filesystem::path& path, const BoardPattern& pattern);

/// Read and write a body of boards that are fixed to each other, such as a cube. The file is that
/// of a ChArUco board, with `first_markers`, the first marker of every face, instead of
/// first_marker. A single board is a body of one. Both throw Error; faces can be saved only if they
/// differ in their markers alone.
std::vector<BoardPattern> load_body(const std::filesystem::path& path);
void save_body(const std::filesystem::path& path, const std::vector<BoardPattern>& faces);

}  // namespace vantage
