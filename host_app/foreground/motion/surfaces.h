#pragma once

#include <algorithm>

#include <opencv2/core.hpp>

namespace vantage {

/// Disparity difference from which on two pixels belong to two surfaces, 1/32 px. Motion from pulse
/// to pulse and matching errors stay below it.
constexpr int one_surface_steps = 48;

/// Returns the pixel of another grid over the same image.
inline cv::Point on_grid(int x, int y, cv::Size size, cv::Size grid) {
    return {std::min((2 * x + 1) * grid.width / (2 * size.width), grid.width - 1),
            std::min((2 * y + 1) * grid.height / (2 * size.height), grid.height - 1)};
}

}  // namespace vantage
