#pragma once

#include "common/image/image.h"
#include "rig_firmware/stereo/thesis/cost_volume.h"

namespace vantage::thesis {

/// What HypothesesPass computes, on the CPU: the absolute differences of left (x, y) and right
/// (x - d, y), summed over the channels, in 1/32 grey levels of their mean (sum * 171 / 16, rounded
/// down), at most max_cost. Beyond the right picture's edge its edge pixel repeats.
CostVolume hypotheses_reference(const ColourImage& left, const ColourImage& right, int disparities);

}  // namespace vantage::thesis
