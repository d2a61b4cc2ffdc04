#pragma once

#include <nlohmann/json.hpp>

#include "calib_tools/rig/rig_calibration.h"

namespace vantage {

// Machine-readable results. Every length in metres, every picture distance in pixels; `sigma` holds
// standard deviations under the names of what they belong to.

nlohmann::json to_json(const CameraCalibration& calibration);
nlohmann::json to_json(const RigCalibration& calibration);

}  // namespace vantage
