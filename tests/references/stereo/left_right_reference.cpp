#include "tests/references/stereo/left_right_reference.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace vantage {

namespace {

/// In 1/32 px, 0..16.
int offset_of(int difference, int steep, Valley valley) {
    if (valley == Valley::sharp) return (16 * difference + (steep >> 1)) / steep;
    const int part = 64 * difference / steep;
    return (part * (96 + part) + 320) / 640;
}

}  // namespace

CheckedDisparity left_right_checked(const Winners& winners, Valley valley) {
    const cv::Size size = winners.disparity.size();
    CheckedDisparity result{DisparityImage(size, 0), cv::Mat1b(size, 0)};
    std::vector<std::uint32_t> claims(static_cast<std::size_t>(size.width));
    for (int y = 0; y < size.height; ++y) {
        std::ranges::fill(claims, 0xffffffffU);
        for (int x = 0; x < size.width; ++x) {
            const int d = winners.disparity(y, x);
            if (d > x) continue;
            const auto cost = static_cast<std::uint32_t>(winners.cost(y, x)) << 12;
            const std::uint32_t normalised = std::min(
                static_cast<std::uint32_t>(static_cast<float>(cost) /
                                           static_cast<float>(std::max(winners.weight(y, x), 1))),
                0xffffU);
            std::uint32_t& claim = claims[static_cast<std::size_t>(x - d)];
            claim = std::min(claim, (normalised << 16) | static_cast<std::uint32_t>(d));
        }
        for (int x = 0; x < size.width; ++x) {
            const int d = winners.disparity(y, x);
            if (d > x) continue;
            const auto claimed =
                static_cast<int>(claims[static_cast<std::size_t>(x - d)] & 0xffffU);
            if (std::abs(claimed - d) > 1) continue;
            const int best = winners.cost(y, x), before = winners.cost_before(y, x),
                      after = winners.cost_after(y, x);
            int position = d * disparity_steps_per_px, rise = 0;
            if (before != no_cost && after != no_cost) {
                const int steep = std::max(std::max(before, after) - best, 1);
                const int offset = offset_of(std::abs(before - after), steep, valley);
                position += before > after ? offset : -offset;
                rise = before + after - 2 * best;
            } else if (before != no_cost || after != no_cost) {
                // At an end of the search one side alone tells.
                rise = std::min(before, after) - best;
            }
            result.disparity(y, x) = static_cast<unsigned short>(std::max(position, 1));
            result.confidence(y, x) =
                static_cast<unsigned char>(std::min(255 * rise / std::max(best + rise, 1), 255));
        }
    }
    return result;
}

}  // namespace vantage
