#pragma once

#include <optional>

#include "common/board/board_pattern.h"
#include "common/board/board_view.h"
#include "common/image/image.h"

namespace vantage {

/// Finds a completely visible chessboard and measures every corner to sub-pixel accuracy
/// (fit_corner). Corners are numbered in the board's frame as seen from the front. If the colours
/// of the squares allow it (columns + rows odd), the numbering is the same from every side. The
/// reason names a board of another size in the image.
BoardSighting find_chessboard(const GreyImage& picture, const BoardPattern& pattern);

/// Finds a board of another common size in the image; empty if there is none. The search is slow:
/// use it for a few images of a series without the right size.
std::optional<BoardPattern> find_other_size(const GreyImage& picture, const BoardPattern& pattern);

/// Numbers the same corners from the opposite end: the second interpretation of a board that looks
/// the same after half a turn.
BoardCorners half_turned(const BoardCorners& corners, const BoardPattern& pattern);

/// True if the board looks the same after half a turn.
bool looks_alike_half_turned(const BoardPattern& pattern);

}  // namespace vantage
