#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// CPU reference of StreakPass, bit for bit. costs: a picture a disparity.
DisparityImage without_streaks(const DisparityImage& disparity,
                               const std::vector<cv::Mat1b>& costs);

}  // namespace vantage
