#pragma once

#include <string>

#include "calib_tools/rig/rig_calibration.h"

namespace vantage {

/// Result as text: quality first, then every parameter with its uncertainty, then refused images
/// and advice.
std::string describe(const CameraCalibration& calibration);
std::string describe(const RigCalibration& calibration);

/// Time of a calibration for its file: UTC, ISO 8601.
std::string date_now();

}  // namespace vantage
