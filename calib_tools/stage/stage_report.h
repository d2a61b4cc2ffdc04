#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "calib_tools/stage/stage_calibration.h"

namespace vantage {

nlohmann::json to_json(const StageCalibration& stage);
std::string describe(const StageCalibration& stage);
/// Sentence about the image that would help most; empty if there is none.
std::string next_picture_sentence(const StageCalibration& stage);

}  // namespace vantage
