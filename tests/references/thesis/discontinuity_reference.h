#pragma once

#include "common/image/image.h"

namespace vantage::thesis {

/// Bits of the discontinuity map: a discontinuity, or the picture's edge, lies on this side.
enum Discontinuity : unsigned char {
    cut_left = 1,
    cut_right = 2,
    cut_above = 4,
    cut_below = 8,
};

/// What DiscontinuityPass computes, on the CPU: a side is cut if the greatest of the three
/// channels' absolute differences to the neighbour there is above `threshold`, or if there is no
/// neighbour.
cv::Mat1b discontinuity_reference(const ColourImage& picture, int threshold);

}  // namespace vantage::thesis
