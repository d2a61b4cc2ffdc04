#pragma once

#include <algorithm>

#include <opencv2/core.hpp>

namespace vantage {

/// Disparities further apart than this are of two surfaces, 1/32 px; what moves from pulse to
/// pulse, with the matcher's own errors, is not.
constexpr int one_surface_steps = 48;

/// The pixel of another grid over the same picture.
inline cv::Point on_grid(int x, int y, cv::Size size, cv::Size grid) {
    return {std::min((2 * x + 1) * grid.width / (2 * size.width), grid.width - 1),
            std::min((2 * y + 1) * grid.height / (2 * size.height), grid.height - 1)};
}

}  // namespace vantage
