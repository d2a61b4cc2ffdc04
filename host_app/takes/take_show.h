#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "common/colour/colour_correction.h"
#include "common/config/stage_config.h"
#include "common/take/take_reader.h"
#include "host_app/flight/flight_plan.h"

namespace vantage {

/// The settings of the show in a take, so that it can be played without the stage file and the
/// rigs' colour files.
struct TakeShow {
    std::string timecode_zone;
    StageConfig::View view;
    std::map<std::string, ColourCorrection> colours = {};  ///< by rig; others are not corrected
};

/// Loads the rigs' colour files. Throws Error if one is invalid.
TakeShow take_show_of(const StageConfig& stage);
nlohmann::ordered_json to_json(const TakeShow& show);
/// Throws Error if the JSON is not what to_json() wrote.
TakeShow take_show_from(const nlohmann::ordered_json& json);

/// The name of the stage file attached to a take.
inline constexpr const char* stage_attachment = "stage.toml";

/// The limits and speeds of flying by hand from a stage file.
FlightHabits habits_of(const StageConfig::Flight& flight);
/// Those of the stage file in a take; the defaults if it has none, or, with a warning, if it cannot
/// be read.
FlightHabits habits_of(const TakeReader& take);

}  // namespace vantage
