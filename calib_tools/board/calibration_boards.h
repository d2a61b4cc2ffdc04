#pragma once

#include <string>
#include <vector>

#include "calib_tools/board/board_pattern.h"

namespace vantage {

/// Something that is carried about as one piece: a board, or several that are fixed to each other
/// (a cube, a wand of cubes) in a way that nobody has to know.
struct BoardBody {
    std::string name;         ///< in sentences
    std::vector<int> boards;  ///< indices into BoardSet::boards
};

/// All boards that pictures may show. Corners of a set are numbered through: those of board 1
/// follow those of board 0.
struct CalibrationBoards {
    std::vector<BoardPattern> boards;
    std::vector<BoardBody> bodies;

    CalibrationBoards() = default;
    /// One board is a set too.
    CalibrationBoards(const BoardPattern& pattern);  // NOLINT(google-explicit-constructor)

    void add(const std::string& name, const std::vector<BoardPattern>& fixed_to_each_other);
    bool is_one_board() const { return boards.size() == 1; }
    int body_of(int board) const;
    int first_corner(int board) const;  ///< number of its first corner in the set
    /// "cube 3" for one of several boards of a body, else the body's name.
    std::string board_name(int board) const;

    /// Throws Error for no board, a chessboard that is not alone, a board twice as another body,
    /// and boards that share markers: each names the two and the mend.
    void validate() const;
};

}  // namespace vantage
