#pragma once

#include <optional>
#include <vector>

#include "calib_tools/stage/stage_calibration.h"

namespace vantage {

/// Removes repeated sightings of boards at rest. A board that every camera sees at the same
/// position as in one earlier frame set adds no information, since its corners have the same
/// errors; counted again it would make the stage seem too certain. Of equal sightings those of the
/// frame set `kept` stay, else the first.
std::vector<StageRig> without_repeats(std::vector<StageRig> rigs, std::optional<long long> kept);

}  // namespace vantage
