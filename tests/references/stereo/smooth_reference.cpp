#include "tests/references/stereo/smooth_reference.h"

#include <algorithm>
#include <cstdlib>

namespace vantage {
namespace {

constexpr int radius = 4;

/// dx, dy: the way to the next pixel of a line.
DisparityImage smoothed_along(const DisparityImage& disparity, int dx, int dy, int most_step) {
    DisparityImage result = disparity.clone();
    const auto known_at = [&](int x, int y) {
        const bool inside = x >= 0 && y >= 0 && x < disparity.cols && y < disparity.rows;
        return inside ? static_cast<int>(disparity(y, x)) : 0;
    };
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x) {
            const int here = disparity(y, x);
            if (here == 0) continue;
            int sum = 0;
            for (int i = 1; i <= radius; ++i) {
                const int before = known_at(x - i * dx, y - i * dy),
                          after = known_at(x + i * dx, y + i * dy);
                if (before > 0 && after > 0 && std::abs(before - here) <= most_step &&
                    std::abs(after - here) <= most_step)
                    sum += before + after - 2 * here;
            }
            // The sum's ninth, rounded.
            result(y, x) =
                static_cast<unsigned short>(std::max(here + ((sum * 7282 + 32768) >> 16), 1));
        }
    return result;
}

}  // namespace

DisparityImage smoothed_where_near(const DisparityImage& disparity, int most_step) {
    return smoothed_along(smoothed_along(disparity, 1, 0, most_step), 0, 1, most_step);
}

}  // namespace vantage
