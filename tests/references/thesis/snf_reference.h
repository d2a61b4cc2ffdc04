#pragma once

#include "common/image/image.h"

namespace vantage::thesis {

/// What SnfPass computes, on the CPU: of each of the four pairs of opposite neighbours in a 3x3
/// window the one nearer to the centre's colour (sum of absolute channel differences; the first at
/// equal distance) is kept; the result is the rounded mean of the four, opaque. Beyond the edge the
/// edge pixel repeats.
ColourImage snf_reference(const ColourImage& picture);

}  // namespace vantage::thesis
