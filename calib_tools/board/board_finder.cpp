#include "calib_tools/board/board_finder.h"

#include <algorithm>
#include <map>

#include "calib_tools/board/charuco_finder.h"
#include "calib_tools/board/chessboard_finder.h"
#include "calib_tools/board/median.h"
#include "common/base/error.h"

namespace vantage {

BoardSighting find_board(const GreyImage& picture, const BoardSet& set) {
    if (set.is_one_board()) {
        const BoardPattern& pattern = set.boards.front();
        return pattern.kind == BoardKind::charuco ? find_charuco(picture, pattern)
                                                  : find_chessboard(picture, pattern);
    }
    std::map<std::string, std::vector<FoundMarker>> markers;
    BoardSighting all;
    std::vector<double> squares, blurs, contrasts;
    for (std::size_t i = 0; i < set.boards.size(); ++i) {
        const BoardPattern& pattern = set.boards[i];
        if (!markers.contains(pattern.dictionary))
            markers[pattern.dictionary] = MarkerDictionary(pattern.dictionary).find(picture);
        const BoardSighting one = find_charuco(picture, pattern, markers[pattern.dictionary]);
        if (!one.found()) continue;
        const int board = static_cast<int>(i), first = set.first_corner(board);
        for (BoardCorner corner : one.corners) {
            corner.id += first;
            corner.board = board;
            all.corners.push_back(corner);
        }
        squares.push_back(one.square_px);
        blurs.push_back(one.blur_px);
        contrasts.push_back(one.contrast);
        all.burnt_out_share = std::max(all.burnt_out_share, one.burnt_out_share);
    }
    if (all.found()) {
        all.square_px = median(squares);
        all.blur_px = median(blurs);
        all.contrast = median(contrasts);
        return all;
    }
    all.mirrored = std::any_of(markers.begin(), markers.end(), [&](const auto& found) {
        return shows_mirrored_markers(picture, found.first);
    });
    all.reason = all.mirrored ? mirrored_reason
                              : fmt::format(
                                    "shows none of the {} boards with enough of its "
                                    "markers to be placed",
                                    set.boards.size());
    return all;
}

}  // namespace vantage
