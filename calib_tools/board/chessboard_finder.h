#pragma once

#include <optional>

#include "calib_tools/board/board_pattern.h"
#include "calib_tools/board/board_view.h"
#include "common/image/image.h"

namespace vantage {

/// Finds a whole chessboard and fits every corner to sub-pixel accuracy (fit_corner). Corners are
/// numbered in the board's frame seen from the front; where the colours of the squares allow it
/// (columns + rows odd) the numbering is the same from every side. A board of another size in the
/// picture is recognised and named.
BoardSighting find_chessboard(const GreyImage& picture, const BoardPattern& pattern);

/// The board of another size that the picture shows, if one of the sizes in use fits; a search that
/// is worth its time only for a few pictures of a series in which the right size is not found.
std::optional<BoardPattern> find_other_size(const GreyImage& picture, const BoardPattern& pattern);

/// The same corners numbered from the opposite end: what a board that looks alike when turned half
/// round may also be.
BoardCorners half_turned(const BoardCorners& corners, const BoardPattern& pattern);

/// True if the board looks the same after half a turn.
bool looks_alike_half_turned(const BoardPattern& pattern);

}  // namespace vantage
