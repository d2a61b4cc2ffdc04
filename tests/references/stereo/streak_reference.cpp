#include "tests/references/stereo/streak_reference.h"

#include <algorithm>
#include <cstdlib>

#include "rig_firmware/stereo/disparity/streak_pass.h"

namespace vantage {
namespace {

/// Rows of a column that hold one surface; what is unknown between them does not count.
struct Run {
    int first_row, last_row;
    int top, bottom;  ///< disparities
};

bool are_of_one_surface(int a, int b) { return std::abs(a - b) <= disparity_steps_per_px; }

std::vector<Run> runs_of(const DisparityImage& disparity, int x) {
    std::vector<Run> runs;
    for (int y = 0; y < disparity.rows; ++y) {
        const int d = disparity(y, x);
        if (d == 0) continue;
        if (runs.empty() || !are_of_one_surface(runs.back().bottom, d))
            runs.push_back({y, y, d, d});
        runs.back().last_row = y;
        runs.back().bottom = d;
    }
    return runs;
}

/// Costs of a pixel's disparities.
class CostsOfPixel {
  public:
    CostsOfPixel(const std::vector<cv::Mat1b>& costs, int x, int y) : costs_(costs), x_(x), y_(y) {}

    /// The lesser of the two whole disparities around one.
    int around(int disparity) const {
        const int whole = disparity / disparity_steps_per_px;
        return std::min(at(whole), at(whole + 1));
    }
    /// The lesser of those two pixels off.
    int beside(int disparity) const {
        const int whole = disparity / disparity_steps_per_px;
        return std::min(at(whole - 2), at(whole + 3));
    }

  private:
    static constexpr int beyond_search = 255;

    int at(int d) const {
        return d < 0 || d >= static_cast<int>(costs_.size())
                   ? beyond_search
                   : costs_[static_cast<std::size_t>(d)](y_, x_);
    }

    const std::vector<cv::Mat1b>& costs_;
    int x_, y_;
};

}  // namespace

DisparityImage without_streaks(const DisparityImage& disparity,
                               const std::vector<cv::Mat1b>& costs) {
    DisparityImage result = disparity.clone();
    for (int x = 0; x < disparity.cols; ++x) {
        const std::vector<Run> runs = runs_of(disparity, x);
        for (std::size_t i = 1; i + 1 < runs.size(); ++i) {
            const Run& run = runs[i];
            const int above = runs[i - 1].bottom, below = runs[i + 1].top;
            if (run.last_row - run.first_row >= max_streak_rows ||
                !are_of_one_surface(above, below))
                continue;
            const int surface = (above + below) / 2;
            for (int y = run.first_row; y <= run.last_row; ++y) {
                const CostsOfPixel pixel(costs, x, y);
                const int expected = pixel.around(surface);
                if (disparity(y, x) &&
                    expected <= pixel.around(disparity(y, x)) + max_streak_gain &&
                    expected + min_streak_valley <= pixel.beside(surface))
                    result(y, x) = 0;
            }
        }
    }
    return result;
}

}  // namespace vantage
