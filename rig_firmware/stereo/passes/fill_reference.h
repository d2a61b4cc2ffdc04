#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU form of FillPass: of the nearest known disparities to the left and right in the row, the
/// smaller (the background).
DisparityImage filled_from_background(const DisparityImage& disparity);

/// CPU form of ResultPass: 3x3 median; unknown (0) stays, unknown neighbours vote as the centre
/// does.
DisparityImage median_of_known(const DisparityImage& disparity);

}  // namespace vantage
