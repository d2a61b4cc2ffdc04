#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// Pixel positions of a full grid of corners, row by row.
struct CornerGrid {
    int columns = 0, rows = 0;
    std::vector<Eigen::Vector2d> pixels;

    const Eigen::Vector2d& at(int column, int row) const {
        return pixels[static_cast<std::size_t>(row * columns + column)];
    }
    /// Swaps rows and columns; the board's front becomes its back.
    CornerGrid transposed() const;
    /// Reverses every row; the board's front becomes its back.
    CornerGrid mirrored() const;
    /// Turns the grid by 180 degrees in the board's plane.
    CornerGrid half_turned() const;
    /// True if seen from the front (x right, y down on the board, z into it).
    bool seen_from_front() const;
    double median_spacing_px() const;
};

/// Mean brightness of the squares with even column + row, minus that of the other squares.
double even_square_brightness(const GreyImage& picture, const CornerGrid& grid);

/// Numbering that is independent of the side the board is seen from: from the front, with black
/// even squares if the size of the board distinguishes them, and then with rows that run to the
/// right.
CornerGrid canonical(const GreyImage& picture, const CornerGrid& grid);

/// Corrects false crossings: a corner that fewer than half of the lines through other corners
/// predict is moved to the predicted position.
CornerGrid without_strays(const CornerGrid& grid);

/// Largest radius around a corner that reaches only the two edges crossing there, times `share`.
double clear_radius_px(const CornerGrid& grid, int column, int row, double share);

}  // namespace vantage
