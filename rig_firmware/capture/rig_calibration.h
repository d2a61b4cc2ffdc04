#pragma once

#include <opencv2/core.hpp>

#include "common/config/rig_config.h"
#include "common/geometry/stereo_calibration.h"

namespace vantage {

/// Calibration of a rig: its file, or the ideal rig of [virtual_rig] if there is no file and the
/// kind of source allows it. Throws Error if the file cannot be used, is for images of another size
/// than `picture_size`, or is required and missing.
StereoCalibration rig_calibration(const RigConfig& config, cv::Size picture_size);

/// Ideal rig of [virtual_rig] for images of this size, with its id.
StereoCalibration ideal_rig(const RigConfig& config, cv::Size picture_size);

}  // namespace vantage
