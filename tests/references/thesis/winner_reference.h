#pragma once

#include <opencv2/core.hpp>

#include "rig_firmware/stereo/thesis/cost_volume.h"

namespace vantage::thesis {

/// What WinnerPass finds, on the CPU: for every pixel the disparity of the lowest cost, the
/// smallest one at equal cost.
cv::Mat1b winner_reference(const CostVolume& costs);

}  // namespace vantage::thesis
