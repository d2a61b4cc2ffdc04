#pragma once

#include <optional>
#include <vector>

#include "calib_tools/stage/stage_calibration.h"

namespace vantage {

/// How large a body's boards are by the rigs' own baselines, as a multiple of their description:
/// the median over all instants at which a rig saw one with both cameras, of the scale that fits
/// the triangulated corners best (noise in depth, large far away, does not bias it). Empty for
/// fewer than three such instants.
std::optional<double> board_scale(const std::vector<StageRig>& rigs, const BoardBody& body);

}  // namespace vantage
