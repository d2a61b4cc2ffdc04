#include "tests/references/stereo/path_fill_reference.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <vector>

#include "tests/references/stereo/row_fill_reference.h"

namespace vantage {
namespace {

bool are_near(int a, int b) { return a && b && std::abs(a - b) <= disparity_steps_per_px; }

/// What most of up to four disparities share, of several such the smallest; 0 if no two do.
unsigned short shared(const std::vector<unsigned short>& disparities) {
    unsigned short best = 0;
    std::ptrdiff_t most = 1;
    for (const unsigned short d : disparities) {
        const auto votes =
            std::ranges::count_if(disparities, [d](int other) { return are_near(d, other); });
        if (votes > most || (votes == most && votes > 1 && d < best)) most = votes, best = d;
    }
    return best;
}

DisparityImage cells_of(const DisparityImage& disparity, FillCell cell) {
    if (cell == FillCell::one_px) return disparity;
    DisparityImage cells((disparity.rows + 1) / 2, (disparity.cols + 1) / 2);
    for (int y = 0; y < cells.rows; ++y)
        for (int x = 0; x < cells.cols; ++x) {
            std::vector<unsigned short> four;
            for (const int row : {2 * y, 2 * y + 1})
                for (const int column : {2 * x, 2 * x + 1})
                    four.push_back(disparity(std::min(row, disparity.rows - 1),
                                             std::min(column, disparity.cols - 1)));
            cells(y, x) = shared(four);
        }
    return cells;
}

/// Calls use(first, end) for every run of joined cells of a line of `count`.
void for_runs(int count, const std::function<bool(int, int)>& joined,
              const std::function<void(int, int)>& use) {
    for (int first = 0; first < count;) {
        int end = first + 1;
        while (end < count && joined(end - 1, end)) ++end;
        use(first, end);
        first = end;
    }
}

cv::Mat1i areas_of(const DisparityImage& cells) {
    cv::Mat1i runs(cells.size()), areas(cells.size());
    for (int y = 0; y < cells.rows; ++y)
        for_runs(
            cells.cols, [&](int a, int b) { return are_near(cells(y, a), cells(y, b)); },
            [&](int first, int end) { runs.row(y).colRange(first, end) = end - first; });
    for (int x = 0; x < cells.cols; ++x)
        for_runs(
            cells.rows, [&](int a, int b) { return are_near(cells(a, x), cells(b, x)); },
            [&](int first, int end) {
                areas.col(x).rowRange(first, end) =
                    static_cast<int>(cv::sum(runs.col(x).rowRange(first, end))[0]);
            });
    return areas;
}

/// What has come to each cell, and the cost of the path it came along.
class Paths {
  public:
    static constexpr int unreached = 0x7fff, step_cost = 4;

    DisparityImage came;
    cv::Mat1i cost;

    Paths(const DisparityImage& cells, const StereoPlanes& picture, int cell_width)
        : came(cells.size(), 0),
          cost(cells.size(), unreached),
          picture_(picture),
          cell_width_(cell_width),
          limit_(cells.size(), 0) {
        const cv::Mat1i areas = areas_of(cells);
        for (int y = 0; y < cells.rows; ++y) {
            cells.row(y).copyTo(came.row(y), areas.row(y) >= min_island_cells);
            if (!cv::countNonZero(came.row(y))) cells.row(y).copyTo(came.row(y));
            int limit = 0;
            for (int x = cells.cols - 1; x >= 0; --x) {
                if (came(y, x)) cost(y, x) = 0;
                limit_(y, x) = limit;
                limit = std::max({limit, static_cast<int>(came(y, x)), cell_width}) - cell_width;
            }
        }
    }

    void walk_left() {
        for (int y = 0; y < came.rows; ++y)
            for (int x = came.cols - 2; x >= 0; --x) advance({x + 1, y}, {x, y});
    }
    void walk_right() {
        for (int y = 0; y < came.rows; ++y)
            for (int x = 1; x < came.cols; ++x) advance({x - 1, y}, {x, y});
    }
    void walk_down_and_up() {
        for (int y = 1; y < came.rows; ++y)
            for (int x = 0; x < came.cols; ++x) advance({x, y - 1}, {x, y});
        for (int y = came.rows - 2; y >= 0; --y)
            for (int x = 0; x < came.cols; ++x) advance({x, y + 1}, {x, y});
    }

    /// The rest takes the background of its row; its cost stays `unreached`.
    void take_background() { came = filled_from_background(came); }

  private:
    void advance(cv::Point from, cv::Point to) {
        const int d = came(from);
        // Hidden by something nearer, or beyond the other camera's border.
        if (!d || (d > limit_(to) && d < (to.x + 1) * cell_width_)) return;
        const int cost_here = cost(from) + step_cost +
                              std::abs(picture_.luma(from) - picture_.luma(to)) +
                              std::abs(picture_.colour(from) - picture_.colour(to));
        if (cost_here > cost(to) || (cost_here == cost(to) && d >= came(to))) return;
        cost(to) = cost_here;
        came(to) = static_cast<unsigned short>(d);
    }

    const StereoPlanes& picture_;
    int cell_width_;
    cv::Mat1i limit_;
};

}  // namespace

DisparityImage filled_along_paths(const DisparityImage& disparity, const StereoPlanes& left,
                                  FillCell cell) {
    const StereoPlanes picture = cell == FillCell::one_px ? left : halved(left);
    Paths paths(cells_of(disparity, cell), picture, px_of(cell) * disparity_steps_per_px);
    paths.walk_left();
    paths.walk_right();
    paths.walk_down_and_up();
    paths.walk_right();
    paths.walk_left();
    paths.take_background();
    DisparityImage filled = disparity.clone();
    for (int y = 0; y < filled.rows; ++y)
        for (int x = 0; x < filled.cols; ++x) {
            const cv::Point at(x / px_of(cell), y / px_of(cell));
            const bool is_hidden = paths.cost(at) > 0 && paths.cost(at) < Paths::unreached;
            if (!filled(y, x) || is_hidden) filled(y, x) = paths.came(at);
        }
    return filled;
}

}  // namespace vantage
