#pragma once

#include <nlohmann/json.hpp>

#include "calib_tools/rig/rig_calibration.h"

namespace vantage {

// Machine-readable results. Lengths are in metres, image distances in pixels; `sigma` holds
// standard deviations under the names of their values.

nlohmann::json to_json(const CameraCalibration& calibration);
nlohmann::json to_json(const RigCalibration& calibration);

}  // namespace vantage
