#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

// What a streak is. Chosen on four photographs and eleven generated scenes, where 8 to 24 rows, a
// gain of 8 to 16 and a valley of 4 to 12 err within a hundredth of it.
inline constexpr int most_streak_rows = 16;
// Of PermPass's costs, 0..most_perm_code.
inline constexpr int most_streak_gain = 12;    ///< over what the surface above and below costs
inline constexpr int least_streak_valley = 8;  ///< that this surface's cost lies in

/// CPU form of StreakPass, bit for bit. costs: a picture a disparity.
DisparityImage without_streaks(const DisparityImage& disparity,
                               const std::vector<cv::Mat1b>& costs);

}  // namespace vantage
