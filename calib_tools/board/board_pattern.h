#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

namespace vantage {

enum class BoardKind {
    chessboard,  ///< must be seen whole
    charuco,     ///< chessboard with ArUco markers in its white squares: may be seen in part
};

/// A flat calibration target. Its frame: origin at the first inner corner, x along a row, y down
/// the columns as one looks at the front, z into the board; metres.
struct BoardPattern {
    BoardKind kind = BoardKind::chessboard;
    int columns = 0, rows = 0;  ///< INNER corners, where four squares meet
    double square_m = 0;        ///< side of a square
    double marker_m = 0;        ///< side of an ArUco marker (charuco)
    std::string dictionary;     ///< of the ArUco markers, e.g. "4X4_100" (charuco)
    int first_marker = 0;  ///< the board's markers are this one and those that follow (charuco)
    /// Laid out as OpenCV did before 4.6: with an even count of rows of squares the upper left one
    /// is white and holds the first marker (charuco).
    bool legacy = false;

    /// The legacy layout is another one for this size.
    bool has_legacy_layout() const { return kind == BoardKind::charuco && rows % 2 == 1; }
    /// The upper left square is white.
    bool starts_white() const { return legacy && has_legacy_layout(); }

    int corner_count() const { return columns * rows; }
    /// Of the inner corner with this number: row * columns + column.
    Eigen::Vector3d corner_m(int id) const {
        const int row = id / columns, column = id % columns;
        return {column * square_m, row * square_m, 0.0};
    }
    std::string size_name() const;  ///< "9x6"

    bool operator==(const BoardPattern&) const = default;

    /// Throws Error naming the first value that cannot be.
    void validate() const;
};

/// A chessboard from "9x6" (inner corners) and the side of a square. Throws Error.
BoardPattern chessboard_pattern(std::string_view size, double square_m);

}  // namespace vantage
