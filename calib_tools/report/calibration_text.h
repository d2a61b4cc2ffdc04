#pragma once

#include <string>

#include "calib_tools/rig/rig_calibration.h"
#include "common/config/intrinsics_file.h"

namespace vantage {

/// Result as text: quality first, then every parameter with its uncertainty, then refused images
/// and advice.
std::string describe(const CameraCalibration& calibration);
std::string describe(const RigCalibration& calibration);

/// Time of a calibration for its file: UTC, ISO 8601.
std::string date_now();

/// The record of a lens that another program calibrated, whose errors are not known.
IntrinsicsRecord record_of_foreign_lens(const CameraModel& camera, const std::string& tool);

}  // namespace vantage
