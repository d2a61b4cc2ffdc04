#include "tests/references/stereo/upsample_reference.h"

#include <algorithm>
#include <cstdlib>

namespace vantage {

DisparityImage upsampled(const DisparityImage& coarse, const GreyImage& coarse_luma,
                         const GreyImage& fine_luma) {
    DisparityImage result(fine_luma.size());
    for (int y = 0; y < result.rows; ++y)
        for (int x = 0; x < result.cols; ++x) {
            // In quarters of a coarse pixel: a fine pixel lies a quarter beside its coarse one's
            // middle.
            const auto far = [](int step, int odd) { return std::abs(4 * step - (odd ? 1 : -1)); };
            const auto cost = [&](int dx, int dy, int cx, int cy) {
                return std::abs(fine_luma(y, x) - coarse_luma(cy, cx)) + far(dx, x % 2) +
                       far(dy, y % 2);
            };
            const int own = coarse(y / 2, x / 2);
            const auto beside_at = [&](int dx, int dy) {
                return cv::Point(std::clamp(x / 2 + dx, 0, coarse.cols - 1),
                                 std::clamp(y / 2 + dy, 0, coarse.rows - 1));
            };
            constexpr int beside[4][2] = {{0, -1}, {0, 1}, {-1, 0}, {1, 0}};
            const bool is_flat =
                own != 0 && std::ranges::all_of(beside, [&](const auto& step) {
                    const int there = coarse(beside_at(step[0], step[1]));
                    return there != 0 && std::abs(there - own) <= disparity_steps_per_px / 2;
                });
            if (is_flat) {
                const int across = coarse(beside_at(x % 2 ? 1 : -1, 0)),
                          down = coarse(beside_at(0, y % 2 ? 1 : -1));
                result(y, x) = static_cast<unsigned short>((2 * own + across + down + 1) >> 1);
                continue;
            }
            int least = cost(0, 0, x / 2, y / 2);
            int best = own;
            for (const auto& [dx, dy] : beside) {
                const auto [cx, cy] = beside_at(dx, dy);
                const int here = cost(dx, dy, cx, cy);
                if (here < least) {
                    least = here;
                    best = coarse(cy, cx);
                }
            }
            result(y, x) = static_cast<unsigned short>(2 * best);
        }
    return result;
}

DisparityImage upsampled_rows(const DisparityImage& coarse, const GreyImage& coarse_luma,
                              const GreyImage& fine_luma) {
    DisparityImage result(fine_luma.size());
    for (int y = 0; y < result.rows; ++y)
        for (int x = 0; x < result.cols; ++x) {
            const int y_beside = std::clamp(y / 2 + (y % 2 ? 1 : -1), 0, coarse.rows - 1);
            const int own = coarse(y / 2, x), beside = coarse(y_beside, x);
            if (own != 0 && beside != 0 && std::abs(own - beside) <= disparity_steps_per_px) {
                result(y, x) = static_cast<unsigned short>((3 * own + beside + 2) >> 2);
                continue;
            }
            // A result lies a quarter of a coarse row beside its own one, and three quarters from
            // the other.
            const int own_cost = std::abs(fine_luma(y, x) - coarse_luma(y / 2, x)) + 1;
            const int beside_cost = std::abs(fine_luma(y, x) - coarse_luma(y_beside, x)) + 3;
            result(y, x) = static_cast<unsigned short>(beside_cost < own_cost ? beside : own);
        }
    return result;
}

}  // namespace vantage
