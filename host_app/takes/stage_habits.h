#pragma once

#include "common/config/stage_config.h"
#include "common/take/take_reader.h"
#include "host_app/flight/flight_plan.h"

namespace vantage {

/// The stage's file in a take that a host recorded.
inline constexpr const char* stage_attachment = "stage.toml";

/// How hands fly, as a stage's file says.
FlightHabits habits_of(const StageConfig::Flight& flight);
/// As the stage's file in a take says; the usual ones where it has none. One that cannot be read is
/// told in the log, and the usual ones are taken: a take is played all the same.
FlightHabits habits_of(const TakeReader& take);

}  // namespace vantage
