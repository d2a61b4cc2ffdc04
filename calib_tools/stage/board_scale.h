#pragma once

#include <optional>
#include <vector>

#include "calib_tools/stage/stage_calibration.h"

namespace vantage {

/// How large the board is by the rigs' own baselines, as a multiple of its description: the median
/// over all instants at which a rig saw it with both cameras, of distances between triangulated
/// corners. Empty for fewer than three such instants.
std::optional<double> board_scale(const std::vector<StageRig>& rigs);

}  // namespace vantage
