#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU reference of RowFillPass, whose sources are supported_disparity(): of the nearest sources
/// (some of the known disparities; all of them in a row that has none) to the left and right in the
/// row, the smaller (the background).
DisparityImage filled_from_background(const DisparityImage& disparity,
                                      const DisparityImage& sources);

/// Everything known is a source.
inline DisparityImage filled_from_background(const DisparityImage& disparity) {
    return filled_from_background(disparity, disparity);
}

}  // namespace vantage
