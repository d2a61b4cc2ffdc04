#include "calib_tools/board/board_finder.h"

#include "calib_tools/board/chessboard_finder.h"

namespace vantage {

BoardSighting find_board(const GreyImage& picture, const BoardPattern& pattern) {
    return find_chessboard(picture, pattern);
}

}  // namespace vantage
