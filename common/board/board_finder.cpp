#include "common/board/board_finder.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "common/base/error.h"
#include "common/board/charuco_finder.h"
#include "common/board/chessboard_finder.h"
#include "common/board/median.h"

namespace vantage {

namespace {

/// Finds all ChArUco boards of the board list; for `exposure` see find_charuco().
BoardSighting find_charuco_boards(const GreyImage& picture, const GreyImage& exposure,
                                  const CalibrationBoards& set) {
    std::map<std::string, std::vector<FoundMarker>> markers;
    BoardSighting all;
    std::vector<double> squares, blurs, contrasts;
    for (std::size_t i = 0; i < set.boards.size(); ++i) {
        const BoardPattern& pattern = set.boards[i];
        if (!markers.contains(pattern.dictionary))
            markers[pattern.dictionary] = MarkerDictionary(pattern.dictionary).find(picture);
        const BoardSighting one =
            find_charuco(picture, exposure, pattern, markers[pattern.dictionary]);
        if (set.is_one_board()) return one;
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
        all.legacy = all.legacy || one.legacy;
    }
    all.square_px = median(squares);
    all.blur_px = median(blurs);
    all.contrast = median(contrasts);
    if (!all.found())
        all.reason =
            fmt::format("shows none of the {} boards with enough of its markers to be placed",
                        set.boards.size());
    return all;
}

}  // namespace

BoardSighting find_board(const GreyImage& picture, const CalibrationBoards& set) {
    if (set.boards.front().kind == BoardKind::chessboard)
        return find_chessboard(picture, set.boards.front());
    BoardSighting sighting = find_charuco_boards(picture, picture, set);
    if (sighting.found()) return sighting;
    GreyImage swapped;
    cv::bitwise_not(picture, swapped);
    BoardSighting inverted = find_charuco_boards(swapped, picture, set);
    if (inverted.found()) {
        inverted.inverted = true;
        return inverted;
    }
    std::set<std::string> dictionaries;
    for (const BoardPattern& pattern : set.boards) dictionaries.insert(pattern.dictionary);
    sighting.mirrored =
        std::any_of(dictionaries.begin(), dictionaries.end(), [&](const std::string& dictionary) {
            return shows_mirrored_markers(picture, dictionary) ||
                   shows_mirrored_markers(swapped, dictionary);
        });
    if (sighting.mirrored) sighting.reason = mirrored_reason;
    return sighting;
}

}  // namespace vantage
