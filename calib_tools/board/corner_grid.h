#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// Pixels of a full grid of corners, row by row.
struct CornerGrid {
    int columns = 0, rows = 0;
    std::vector<Eigen::Vector2d> pixels;

    const Eigen::Vector2d& at(int column, int row) const {
        return pixels[static_cast<std::size_t>(row * columns + column)];
    }
    /// Rows become columns; the board's front becomes its back.
    CornerGrid transposed() const;
    /// Every row from its other end; the board's front becomes its back.
    CornerGrid mirrored() const;
    /// Half a turn in the board's plane.
    CornerGrid half_turned() const;
    /// True if seen from the front (x right, y down on the board, z into it).
    bool seen_from_front() const;
    double median_spacing_px() const;
};

/// Mean brightness of the squares whose column + row is even, minus that of the others.
double even_square_brightness(const GreyImage& picture, const CornerGrid& grid);

/// The numbering that is the same from every side: seen from the front, even squares black where
/// the size of the board tells them apart, and then rows that run to the right.
CornerGrid canonical(const GreyImage& picture, const CornerGrid& grid);

/// A finder may take one crossing for another: a corner to which fewer than half of the lines of
/// the others lead is put where they lead.
CornerGrid without_strays(const CornerGrid& grid);

/// Largest radius around a corner that reaches no other edge than the two that cross there, times
/// `share`.
double clear_radius_px(const CornerGrid& grid, int column, int row, double share);

}  // namespace vantage
