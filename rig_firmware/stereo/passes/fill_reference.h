#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU form of FillPass: of the nearest sources (some of the known disparities; all of them in a
/// row that has none) to the left and right in the row, the smaller (the background).
DisparityImage filled_from_background(const DisparityImage& disparity,
                                      const DisparityImage& sources);

/// Everything known is a source.
inline DisparityImage filled_from_background(const DisparityImage& disparity) {
    return filled_from_background(disparity, disparity);
}

/// CPU form of MedianPass: 3x3 median; unknown (0) stays, unknown neighbours vote as the centre
/// does.
DisparityImage median_of_known(const DisparityImage& disparity);

}  // namespace vantage
