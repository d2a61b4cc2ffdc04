#pragma once

#include <span>

#include "common/base/shared_bytes.h"
#include "common/image/image.h"

namespace vantage {

/// The picture of everything that stands still in a rig's right images of different times: for each
/// channel of a pixel, the mean of the middle half of its values. Moving people and noise vanish.
///
/// @param jpegs images of `size`; damaged ones are ignored
/// @return empty if fewer than three are intact
ColourImage still_picture(std::span<const SharedBytes> jpegs, cv::Size size);

}  // namespace vantage
