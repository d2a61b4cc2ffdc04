#pragma once

#include <opencv2/core.hpp>

#include "common/config/rig_config.h"
#include "common/geometry/stereo_calibration.h"

namespace vantage {

/// The calibration a rig works with: its file, or the ideal rig of [virtual_rig] where there is
/// none and the source's kind allows it. Throws Error if the file cannot be used, is for pictures
/// of another size than `picture_size`, or is needed and missing.
StereoCalibration rig_calibration(const RigConfig& config, cv::Size picture_size);

/// The ideal rig of [virtual_rig] for pictures of this size, with its id.
StereoCalibration ideal_rig(const RigConfig& config, cv::Size picture_size);

}  // namespace vantage
