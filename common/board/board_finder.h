#pragma once

#include "common/board/board_view.h"
#include "common/board/calibration_boards.h"
#include "common/image/image.h"

namespace vantage {

/// Finds all boards of the list in an image, of either kind, and measures their corners to a
/// fraction of a pixel. It searches markers once per dictionary, and again with black and white
/// swapped if it finds no board.
BoardSighting find_board(const GreyImage& picture, const CalibrationBoards& set);

}  // namespace vantage
