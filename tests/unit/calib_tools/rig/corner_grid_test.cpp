#include "common/board/corner_grid.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// A board of 9x6 corners that lies on a floor: squares at its far end are half as large.
CornerGrid seen_on_a_floor() {
    CornerGrid grid{9, 6, {}};
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const double depth = 2 - 0.12 * column - 0.05 * row;
            grid.pixels.emplace_back(100 + 40 * column / depth + 15 * row / depth,
                                     300 - 12 * column / depth + 18 * row / depth);
        }
    return grid;
}

TEST(CornerGrid, leaves_corners_that_fit_each_other_alone) {
    const CornerGrid grid = seen_on_a_floor();
    EXPECT_EQ(without_strays(grid).pixels, grid.pixels);
}

TEST(CornerGrid, puts_a_corner_that_was_taken_for_another_where_the_others_lead) {
    const CornerGrid truth = seen_on_a_floor();
    for (int row = 0; row < truth.rows; ++row)
        for (int column = 0; column < truth.columns; ++column) {
            CornerGrid grid = truth;
            const auto at = static_cast<std::size_t>(row * grid.columns + column);
            grid.pixels[at] = truth.at(column, row == 0 ? 1 : row - 1);
            const double spacing_px = (grid.pixels[at] - truth.pixels[at]).norm();
            const CornerGrid led = without_strays(grid);
            for (std::size_t i = 0; i < led.pixels.size(); ++i)
                EXPECT_LT((led.pixels[i] - truth.pixels[i]).norm(),
                          i == at ? 0.2 * spacing_px : 1e-12)
                    << column << ", " << row << ", corner " << i;
        }
}

}  // namespace
}  // namespace vantage
