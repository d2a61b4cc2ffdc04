#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "common/colour/colour_correction.h"
#include "common/config/stage_config.h"

namespace vantage {

/// What a take tells of the show that it was recorded at, so that it can be played where neither
/// the stage's file nor the rigs' colours are at hand.
struct TakeShow {
    std::string timecode_zone;
    StageConfig::View view;
    std::map<std::string, ColourCorrection> colours = {};  ///< by rig; others stay as they are
};

/// Loads the rigs' colour files. Throws Error if one cannot be.
TakeShow take_show_of(const StageConfig& stage);
nlohmann::ordered_json to_json(const TakeShow& show);
/// Throws Error if it is not what to_json wrote.
TakeShow take_show_from(const nlohmann::ordered_json& json);

}  // namespace vantage
