#pragma once

#include <string>

#include "calib_tools/rig/rig_calibration.h"

namespace vantage {

/// The result as lines for a person: quality first, then every parameter with its uncertainty, then
/// what was refused and what would help.
std::string describe(const CameraCalibration& calibration);
std::string describe(const RigCalibration& calibration);

/// The moment of a calibration for its file: UTC, ISO 8601.
std::string date_now();

}  // namespace vantage
