#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "calib_tools/board/paper.h"
#include "common/board/board_pattern.h"
#include "common/image/image.h"

namespace vantage {

/// Black or white rectangle of a board, in metres from the upper left of its outer squares.
struct BoardPatch {
    cv::Rect2d place_m;
    bool black = true;
};

/// Rectangles in painting order, on a white page.
std::vector<BoardPatch> board_patches(const BoardPattern& pattern);

/// Width in metres of the white border that detection needs around the squares.
double board_margin_m(const BoardPattern& pattern);

/// Draws the board with its margin; one square is `square_px` wide.
GreyImage draw_board(const BoardPattern& pattern, int square_px);

/// Draws a PDF page with the board at its true size, and a ruler to check the print. A body of
/// several boards gets a page for each, with a frame to cut along. The page is as large as
/// necessary, or the given sheet. Throws Error if a board does not fit the sheet, or a PDF page
/// (max_page_m).
std::vector<std::byte> board_as_pdf(const std::vector<BoardPattern>& faces,
                                    const std::optional<Paper>& paper = {});

}  // namespace vantage
