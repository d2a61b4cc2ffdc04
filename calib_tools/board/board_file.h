#pragma once

#include <filesystem>

#include "calib_tools/board/board_pattern.h"

namespace vantage {

/// A board's description (TOML, version 1): kind, columns, rows, square_m, and for ChArUco marker_m
/// and dictionary. Both throw Error; unknown keys are refused.
BoardPattern load_board(const std::filesystem::path& path);
void save_board(const std::filesystem::path& path, const BoardPattern& pattern);

}  // namespace vantage
