#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU reference of MedianPass: 3x3 median; unknown (0) stays, unknown neighbours vote as the
/// centre does.
DisparityImage median_of_known(const DisparityImage& disparity);

}  // namespace vantage
