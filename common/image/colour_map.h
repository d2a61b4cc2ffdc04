#pragma once

#include "common/image/image.h"

namespace vantage {

/// Colour-maps disparities (px) for people: near = red, far = blue (Turbo), unknown (<= 0 or not
/// finite) = black. The range is fixed by the caller so that a stream does not flicker.
ColourImage colour_map_disparity(const cv::Mat1f& disparity_px, float min_px, float max_px);

/// Wire disparities to pixels as float; 0 stays 0 = unknown.
cv::Mat1f to_float_px(const DisparityImage& disparity);

}  // namespace vantage
