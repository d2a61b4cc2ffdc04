#pragma once

#include <opencv2/core.hpp>

#include "rig_firmware/stereo/thesis/cost_volume.h"

namespace vantage::thesis {

/// What one AggregationPass computes, on the CPU: every cost is averaged along its row and then,
/// together with its neighbours' row sums, along its column, with weights in eighths from this
/// table; a pixel's own discontinuities choose. Rounded once, to nearest.
///   none: 3 2 3    before: 0 5 3    after: 3 5 0    both: 0 8 0
CostVolume aggregation_reference(const CostVolume& costs, const cv::Mat1b& discontinuities);

}  // namespace vantage::thesis
