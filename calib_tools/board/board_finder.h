#pragma once

#include "calib_tools/board/board_view.h"
#include "calib_tools/board/calibration_boards.h"
#include "common/image/image.h"

namespace vantage {

/// Finds the boards of the set that the picture shows, whatever their kind, and measures their
/// corners to a fraction of a pixel. Markers are searched once a dictionary, and where no board is
/// found, once more with black and white swapped.
BoardSighting find_board(const GreyImage& picture, const CalibrationBoards& set);

}  // namespace vantage
