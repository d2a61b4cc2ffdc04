#include "calib_tools/board/board_finder.h"

#include "calib_tools/board/charuco_finder.h"
#include "calib_tools/board/chessboard_finder.h"

namespace vantage {

BoardSighting find_board(const GreyImage& picture, const BoardPattern& pattern) {
    return pattern.kind == BoardKind::charuco ? find_charuco(picture, pattern)
                                              : find_chessboard(picture, pattern);
}

}  // namespace vantage
