#pragma once

#include "common/image/image.h"

namespace vantage {

/// Of 25 pixels, the disparity's own among them.
inline constexpr int least_support_votes = 12;

/// CPU form of SupportPass: a disparity stays where at least least_support_votes of the 5x5 pixels
/// two apart around it (edges repeated) are known and within one pixel of it; else it is unknown.
DisparityImage supported_disparity(const DisparityImage& disparity);

}  // namespace vantage
