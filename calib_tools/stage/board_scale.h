#pragma once

#include <optional>
#include <vector>

#include "calib_tools/stage/stage_calibration.h"

namespace vantage {

/// Size of a body's boards as measured with the rigs' baselines, relative to their description. It
/// is the median over all frame sets in which both cameras of a rig saw a board, of the scale that
/// fits the triangulated corners best; depth noise, which is large far away, does not bias it.
/// Empty for fewer than three such frame sets.
std::optional<double> board_scale(const std::vector<StageRig>& rigs, const BoardBody& body);

}  // namespace vantage
