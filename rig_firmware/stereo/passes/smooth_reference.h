#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU form of SmoothPass, bit for bit.
DisparityImage smoothed_where_near(const DisparityImage& disparity);

}  // namespace vantage
