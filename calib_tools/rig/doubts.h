#pragma once

#include <string>
#include <vector>

#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// Facts about a calibration besides its solution.
struct DoubtEvidence {
    std::vector<std::string> camera_names;  ///< of the cameras in the bundle
    double held_out_rms_px = 0;             ///< of the chosen lens family
    double alone_sigma_px = 0;  ///< robust sigma of each camera solved alone; 0: not known
};

/// Warning, with advice, if two cameras fit worse together than each alone; empty if they do not.
/// Both arguments are robust sigmas in pixels.
std::string doubt_together(double together_sigma_px, double alone_sigma_px);

/// Warnings about a calibration that is good enough to be written, each with advice: corners that
/// do not fit the model, cameras that fit worse together than alone, parameters that the images
/// hardly determine, and unusual lenses or pixels. Empty for a good calibration.
std::vector<std::string> doubts_of(const Bundle& bundle, const BundleUncertainty& uncertainty,
                                   const DoubtEvidence& evidence);

}  // namespace vantage
