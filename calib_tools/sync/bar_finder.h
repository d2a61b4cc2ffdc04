#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// Spot of an image that blinks; possibly an LED.
struct BlinkingSpot {
    cv::Point2d centre_px;
    double radius_px = 0;
};

/// Spots in a row at even distances, apart from perspective; possibly the LEDs of a bar, from one
/// end to the other. The direction is not known.
using SpotRow = std::vector<BlinkingSpot>;

/// Finds rows of blinking spots in the images of one sensor. All images have one size, and camera
/// and bar are at rest. Spots are compact and change far more than their surroundings. Returns a
/// few rows at most, longest first. LEDs that are faster than the exposure do not blink and are
/// missing. `spots` receives the number of all blinking spots.
std::vector<SpotRow> find_spot_rows(const std::vector<GreyImage>& pictures, int& spots);

}  // namespace vantage
