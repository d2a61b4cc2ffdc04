#pragma once

#include "common/image/image.h"

namespace vantage::thesis {

/// What DisparityPass computes, on the CPU: winners (px) in 1/32 px, 1 for a match at infinity. A
/// winner greater than its x has no match: with `fill` it takes the disparity of the next match to
/// its right, without it (or if there is none) it stays 0 = unknown.
DisparityImage disparity_reference(const cv::Mat1b& winners, bool fill);

}  // namespace vantage::thesis
