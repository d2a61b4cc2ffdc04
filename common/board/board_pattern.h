#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

namespace vantage {

enum class BoardKind {
    chessboard,  ///< must be completely visible
    charuco,     ///< chessboard with ArUco markers in its white squares: may be partly visible
};

/// Flat calibration target. Its coordinate frame in metres: origin at the first inner corner, x
/// along a row, y down the columns as seen from the front, z into the board.
struct BoardPattern {
    BoardKind kind = BoardKind::chessboard;
    int columns = 0, rows = 0;  ///< number of INNER corners, where four squares meet
    double square_m = 0;        ///< side of a square
    double marker_m = 0;        ///< side of an ArUco marker (charuco)
    std::string dictionary;     ///< name of the ArUco dictionary, e.g. "4X4_100" (charuco)
    int first_marker = 0;       ///< number of the first marker; the others follow it (charuco)
    /// Layout of OpenCV before 4.6: with an even number of rows of squares, the upper left square
    /// is white and holds the first marker (charuco).
    bool legacy = false;

    /// True if the legacy layout differs at this size.
    bool has_legacy_layout() const { return kind == BoardKind::charuco && rows % 2 == 1; }
    /// True if the upper left square is white.
    bool starts_white() const { return legacy && has_legacy_layout(); }

    int corner_count() const { return columns * rows; }
    /// Position of an inner corner; its number is row * columns + column.
    Eigen::Vector3d corner_m(int id) const {
        const int row = id / columns, column = id % columns;
        return {column * square_m, row * square_m, 0.0};
    }
    std::string size_name() const;  ///< Size as text, e.g. "9x6".

    bool operator==(const BoardPattern&) const = default;

    /// Throws Error that names the first invalid value.
    void validate() const;
};

/// Creates a chessboard from the number of inner corners, "9x6", and the side of a square. Throws
/// Error.
BoardPattern chessboard_pattern(std::string_view size, double square_m);

}  // namespace vantage
