#pragma once

#include <string>
#include <vector>

#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// What is known of a calibration beside its solution.
struct DoubtEvidence {
    std::vector<std::string> camera_names;  ///< of the bundle's cameras
    double held_out_rms_px = 0;             ///< of the chosen lens family
    double alone_sigma_px = 0;              ///< robust, of each camera solved alone; 0: not known
};

/// How much worse two cameras fit together than each alone, a sentence with what to do; empty if
/// they fit alike. Both robust sigmas, px.
std::string doubt_together(double together_sigma_px, double alone_sigma_px);

/// Reasons not to trust a calibration that is good enough to be written, a sentence each with what
/// to do: corners that miss the model, two cameras that fit worse together than alone, parameters
/// that the pictures hardly determine, lenses or pixels that are unusual. Empty for a sound one.
std::vector<std::string> doubts_of(const Bundle& bundle, const BundleUncertainty& uncertainty,
                                   const DoubtEvidence& evidence);

}  // namespace vantage
