#pragma once

#include <optional>
#include <vector>

#include "calib_tools/stage/stage_calibration.h"

namespace vantage {

/// The rigs without sightings of boards that lay still: a board that every camera sees where the
/// same camera saw it at one earlier instant tells nothing new, since its corners err as they did
/// then; counted again and again it would make the stage seem more certain than it is. Of equal
/// sightings those at the instant `kept` stay, else the first.
std::vector<StageRig> without_repeats(std::vector<StageRig> rigs, std::optional<long long> kept);

}  // namespace vantage
