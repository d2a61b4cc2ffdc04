#include "common/board/calibration_boards.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/board/charuco_finder.h"

namespace vantage {
namespace {

/// 4X4_50 holds the first fifty markers of 4X4_1000, so that the part before the count identifies
/// the markers.
std::string markers_alike(const std::string& dictionary) {
    return dictionary.substr(0, dictionary.find('_'));
}

}  // namespace

CalibrationBoards::CalibrationBoards(const BoardPattern& pattern) {
    add(pattern.size_name(), {pattern});
}

void CalibrationBoards::add(const std::string& name,
                            const std::vector<BoardPattern>& fixed_to_each_other) {
    BoardBody body{name, {}};
    for (const BoardPattern& board : fixed_to_each_other) {
        body.boards.push_back(static_cast<int>(boards.size()));
        boards.push_back(board);
    }
    bodies.push_back(body);
}

int CalibrationBoards::body_of(int board) const {
    const auto holds = [&](const BoardBody& body) {
        return std::find(body.boards.begin(), body.boards.end(), board) != body.boards.end();
    };
    return static_cast<int>(std::find_if(bodies.begin(), bodies.end(), holds) - bodies.begin());
}

int CalibrationBoards::first_corner(int board) const {
    int first = 0;
    for (int i = 0; i < board; ++i) first += boards[static_cast<std::size_t>(i)].corner_count();
    return first;
}

std::string CalibrationBoards::board_name(int board) const {
    const BoardBody& body = bodies[static_cast<std::size_t>(body_of(board))];
    if (body.boards.size() == 1) return body.name;
    return fmt::format("{} {}", body.name, board - body.boards.front() + 1);
}

void CalibrationBoards::validate() const {
    if (boards.empty()) fail("no board is described");
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (bodies[i].name == bodies[k].name)
                fail("two boards are named {}: give each file a name of its own", bodies[i].name);
    for (int i = 0; i < static_cast<int>(boards.size()); ++i) {
        const BoardPattern& a = boards[static_cast<std::size_t>(i)];
        if (a.kind == BoardKind::chessboard && !is_one_board())
            fail(
                "{} is a plain chessboard, which cannot be told from other boards: take ChArUco "
                "boards where there are several",
                board_name(i));
        for (int k = 0; k < i; ++k) {
            const BoardPattern& b = boards[static_cast<std::size_t>(k)];
            if (markers_alike(a.dictionary) == markers_alike(b.dictionary) &&
                a.first_marker < b.first_marker + marker_count(b) &&
                b.first_marker < a.first_marker + marker_count(a))
                fail(
                    "{} and {} share markers of {} (from {} and from {}): print one of them with "
                    "other markers (board --first-marker {})",
                    board_name(k), board_name(i), markers_alike(a.dictionary), b.first_marker,
                    a.first_marker,
                    std::max(a.first_marker + marker_count(a), b.first_marker + marker_count(b)));
        }
    }
}

}  // namespace vantage
