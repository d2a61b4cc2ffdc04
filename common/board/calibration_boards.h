#pragma once

#include <string>
#include <vector>

#include "common/board/board_pattern.h"

namespace vantage {

/// Object that moves as one piece: a board, or several boards fixed to each other (a cube, a wand
/// of cubes). Their relative poses need not be known.
struct BoardBody {
    std::string name;         ///< name in sentences
    std::vector<int> boards;  ///< indices into CalibrationBoards::boards
};

/// All boards that images may show. Corners are numbered through: those of board 1 follow those of
/// board 0.
struct CalibrationBoards {
    std::vector<BoardPattern> boards;
    std::vector<BoardBody> bodies;

    CalibrationBoards() = default;
    /// A single board converts to a list of one.
    CalibrationBoards(const BoardPattern& pattern);  // NOLINT(google-explicit-constructor)

    void add(const std::string& name, const std::vector<BoardPattern>& fixed_to_each_other);
    bool is_one_board() const { return boards.size() == 1; }
    int body_of(int board) const;
    int first_corner(int board) const;  ///< number of its first corner in the list
    /// "cube 3" for one of several boards of a body, else the name of the body.
    std::string board_name(int board) const;

    /// Throws Error for an empty list, a chessboard beside other boards, one board in two bodies,
    /// and boards that share markers. The message names both boards and the mend.
    void validate() const;
};

}  // namespace vantage
