#include "common/board/corner_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/board/median.h"

namespace vantage {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d row_direction(const CornerGrid& g) {
    return g.at(g.columns - 1, 0) - g.at(0, 0) + g.at(g.columns - 1, g.rows - 1) -
           g.at(0, g.rows - 1);
}

Eigen::Vector2d column_direction(const CornerGrid& g) {
    return g.at(0, g.rows - 1) - g.at(0, 0) + g.at(g.columns - 1, g.rows - 1) -
           g.at(g.columns - 1, 0);
}

}  // namespace

CornerGrid CornerGrid::transposed() const {
    CornerGrid g{rows, columns, {}};
    for (int r = 0; r < g.rows; ++r)
        for (int c = 0; c < g.columns; ++c) g.pixels.push_back(at(r, c));
    return g;
}

CornerGrid CornerGrid::mirrored() const {
    CornerGrid g{columns, rows, {}};
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) g.pixels.push_back(at(columns - 1 - c, r));
    return g;
}

CornerGrid CornerGrid::half_turned() const {
    CornerGrid g{columns, rows, {pixels.rbegin(), pixels.rend()}};
    return g;
}

bool CornerGrid::seen_from_front() const {
    return cross(row_direction(*this), column_direction(*this)) > 0;
}

double CornerGrid::median_spacing_px() const {
    std::vector<double> spacings;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            if (c > 0) spacings.push_back((at(c, r) - at(c - 1, r)).norm());
            if (r > 0) spacings.push_back((at(c, r) - at(c, r - 1)).norm());
        }
    return median(std::move(spacings));
}

double even_square_brightness(const GreyImage& picture, const CornerGrid& grid) {
    double sum[2] = {0, 0};
    int count[2] = {0, 0};
    for (int r = 0; r + 1 < grid.rows; ++r)
        for (int c = 0; c + 1 < grid.columns; ++c) {
            const Eigen::Vector2d middle = 0.25 * (grid.at(c, r) + grid.at(c + 1, r) +
                                                   grid.at(c, r + 1) + grid.at(c + 1, r + 1));
            const int x = static_cast<int>(std::lround(middle.x()));
            const int y = static_cast<int>(std::lround(middle.y()));
            if (x < 0 || y < 0 || x >= picture.cols || y >= picture.rows) continue;
            sum[(r + c) & 1] += picture(y, x);
            ++count[(r + c) & 1];
        }
    return sum[0] / std::max(1, count[0]) - sum[1] / std::max(1, count[1]);
}

CornerGrid canonical(const GreyImage& picture, const CornerGrid& grid) {
    CornerGrid g = grid.seen_from_front() ? grid : grid.mirrored();
    std::vector<CornerGrid> candidates{g, g.half_turned()};
    if (g.columns == g.rows) {
        candidates.push_back(g.transposed().mirrored());
        candidates.push_back(candidates.back().half_turned());
    }
    const auto rank = [&](const CornerGrid& candidate) {
        const bool black_first = even_square_brightness(picture, candidate) < 0;
        return std::pair(black_first, row_direction(candidate).x());
    };
    return *std::max_element(
        candidates.begin(), candidates.end(),
        [&](const CornerGrid& a, const CornerGrid& b) { return rank(a) < rank(b); });
}

CornerGrid without_strays(const CornerGrid& grid) {
    constexpr double stray_share = 0.4;  // share of the distance between corners
    CornerGrid led = grid;
    for (int r = 0; r < grid.rows; ++r)
        for (int c = 0; c < grid.columns; ++c) {
            std::vector<double> xs, ys;
            int lines = 0, lead_here = 0;
            for (const auto& [dc, dr] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
                const auto is_there = [&, dc = dc, dr = dr](int step) {
                    const int c1 = c + step * dc, r1 = r + step * dr;
                    return c1 >= 0 && r1 >= 0 && c1 < grid.columns && r1 < grid.rows;
                };
                // A third corner on the line also gives its foreshortening.
                if (!is_there(3)) continue;
                const Eigen::Vector2d &first = grid.at(c + dc, r + dr),
                                      &second = grid.at(c + 2 * dc, r + 2 * dr),
                                      &third = grid.at(c + 3 * dc, r + 3 * dr);
                const Eigen::Vector2d there = 3 * first - 3 * second + third;
                ++lines;
                if ((grid.at(c, r) - there).norm() < stray_share * (second - first).norm())
                    ++lead_here;
                xs.push_back(there.x());
                ys.push_back(there.y());
            }
            if (2 * lead_here < lines)
                led.pixels[static_cast<std::size_t>(r * grid.columns + c)] = {median(xs),
                                                                              median(ys)};
        }
    return led;
}

double clear_radius_px(const CornerGrid& grid, int column, int row, double share) {
    double radius = std::numeric_limits<double>::max();
    const Eigen::Vector2d& p = grid.at(column, row);
    const auto neighbour = [&](int c, int r) {
        return c >= 0 && r >= 0 && c < grid.columns && r < grid.rows;
    };
    const int c2 = column > 0 ? column - 1 : column + 1, r2 = row > 0 ? row - 1 : row + 1;
    const Eigen::Vector2d along_row = (grid.at(c2, row) - p).normalized();
    const Eigen::Vector2d along_column = (grid.at(column, r2) - p).normalized();
    for (const int step : {-1, 1}) {
        // The next edge is parallel to the other direction, so that the distance across it counts.
        if (neighbour(column + step, row))
            radius =
                std::min(radius, std::abs(cross(grid.at(column + step, row) - p, along_column)));
        if (neighbour(column, row + step))
            radius = std::min(radius, std::abs(cross(grid.at(column, row + step) - p, along_row)));
    }
    return share * radius;
}

}  // namespace vantage
