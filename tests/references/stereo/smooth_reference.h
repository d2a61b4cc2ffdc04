#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU reference of SmoothPass, bit for bit. most_step: how far apart in disparity pixels may lie
/// that belong to one surface, in 1/32 px.
DisparityImage smoothed_where_near(const DisparityImage& disparity,
                                   int most_step = disparity_steps_per_px);

}  // namespace vantage
