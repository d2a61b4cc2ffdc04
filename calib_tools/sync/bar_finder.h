#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// A spot of a picture that blinks: an LED, perhaps.
struct BlinkingSpot {
    cv::Point2d centre_px;
    double radius_px = 0;
};

/// Spots in a row at even distances, but for perspective: LEDs of a bar, perhaps, from one end to
/// the other; which end is which is not known.
using SpotRow = std::vector<BlinkingSpot>;

/// What blinks like a bar in the pictures of one sensor, all of one size, of a camera and a bar
/// that stand still: compact spots that change, far more than what is around them. The longest row
/// first, a few at most. LEDs that are faster than the exposure do not blink and are in none.
/// `spots` counts all that blinks.
std::vector<SpotRow> find_spot_rows(const std::vector<GreyImage>& pictures, int& spots);

}  // namespace vantage
