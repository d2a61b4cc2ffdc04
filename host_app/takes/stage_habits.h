#pragma once

#include "common/config/stage_config.h"
#include "common/take/take_reader.h"
#include "host_app/flight/flight_habits.h"

namespace vantage {

/// The name of the stage file attached to a take.
inline constexpr const char* stage_attachment = "stage.toml";

/// The limits and speeds of flying by hand from a stage file.
FlightHabits habits_of(const StageConfig::Flight& flight);
/// Those of the stage file in a take; the defaults if it has none, or, with a warning, if it cannot
/// be read.
FlightHabits habits_of(const TakeReader& take);

}  // namespace vantage
