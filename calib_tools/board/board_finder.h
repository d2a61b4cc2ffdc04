#pragma once

#include "calib_tools/board/board_pattern.h"
#include "calib_tools/board/board_view.h"
#include "common/image/image.h"

namespace vantage {

/// Finds the board, whatever its kind, and measures its corners to a fraction of a pixel.
BoardSighting find_board(const GreyImage& picture, const BoardPattern& pattern);

}  // namespace vantage
