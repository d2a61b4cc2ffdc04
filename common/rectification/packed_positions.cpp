#include "common/rectification/packed_positions.h"

#include <cmath>
#include <cstdint>

namespace vantage {
namespace {

constexpr int bias = 1 << 15;

/// Of one coordinate; empty where it does not fit.
std::optional<std::uint32_t> packed(float position, int pixel) {
    const int steps = static_cast<int>(std::floor(position * 256 + 0.5F)) - 256 * pixel + bias;
    if (steps <= 0 || steps > 0xffff) return {};
    return static_cast<std::uint32_t>(steps);
}

}  // namespace

std::optional<cv::Mat1i> packed_positions(const cv::Mat2f& positions, cv::Size raw_size) {
    cv::Mat1i words(positions.size(), 0);
    const auto width = static_cast<float>(raw_size.width),
               height = static_cast<float>(raw_size.height);
    for (int y = 0; y < positions.rows; ++y)
        for (int x = 0; x < positions.cols; ++x) {
            const cv::Vec2f& at = positions(y, x);
            // A position that is not a number fails these, too.
            if (!(at[0] > -1 && at[1] > -1 && at[0] < width && at[1] < height)) continue;
            const auto right = packed(at[0], x), below = packed(at[1], y);
            if (!right || !below) return {};
            words(y, x) = static_cast<int>(*right | *below << 16);
        }
    return words;
}

}  // namespace vantage
