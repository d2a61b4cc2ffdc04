#pragma once

#include <string>

#include "calib_tools/stage/camera_pairs.h"

namespace vantage {

struct StagePairsOptions {
    std::string stage;   ///< stage file with [[cameras]]
    std::string output;  ///< folder for the rigs' files
    PairLimits limits;
    double alpha = 0;
    bool json = false;
};

/// Forms stereo rigs of a stage's single cameras and writes for each a calibration and a rig file,
/// and a stage file with the rigs and the cameras that are left. Prints what was formed, with the
/// limits. Throws Error if no pair can be formed.
void form_stage_pairs(const StagePairsOptions& options);

}  // namespace vantage
