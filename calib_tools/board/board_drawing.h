#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "calib_tools/board/board_pattern.h"
#include "calib_tools/board/paper.h"
#include "common/image/image.h"

namespace vantage {

/// A black or white rectangle of a board, metres from the upper left of its outer squares.
struct BoardPatch {
    cv::Rect2d place_m;
    bool black = true;
};

/// In the order in which they are painted, on white.
std::vector<BoardPatch> board_patches(const BoardPattern& pattern);

/// Width of the white border that a finder needs around the squares.
double board_margin_m(const BoardPattern& pattern);

/// The board with its margin; one square is `square_px` wide.
GreyImage draw_board(const BoardPattern& pattern, int square_px);

/// A page that holds the board at its true size, with a ruler to check the print by; of a body of
/// several boards a page each, with a frame to cut along. The page is as large as it needs, or the
/// given sheet. Throws Error if a board does not fit the sheet, or a PDF page (max_page_m).
std::vector<std::byte> board_as_pdf(const std::vector<BoardPattern>& faces,
                                    const std::optional<Paper>& paper = {});

}  // namespace vantage
