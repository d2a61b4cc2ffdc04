#pragma once

#include <span>

#include "common/base/shared_bytes.h"
#include "common/image/image.h"

namespace vantage {

/// What stands still in a rig's right pictures, which came at different times: of every channel of
/// a pixel the mean of the middle half. What passed by is not in it, nor noise.
///
/// @param jpegs as they came, all of `size`; one that is damaged is left out.
/// @return empty if there are fewer than three.
ColourImage still_picture(std::span<const SharedBytes> jpegs, cv::Size size);

}  // namespace vantage
