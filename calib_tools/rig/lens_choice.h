#pragma once

#include <string>
#include <vector>

#include "calib_tools/rig/camera_solver.h"

namespace vantage {

/// Candidate in the choice of a lens family.
struct LensTrial {
    const LensFamily* family = nullptr;
    double held_out_rms_px = 0;  ///< on views that were withheld from the calibration
    std::string excluded;        ///< reason why it cannot be chosen; empty if it can
};

struct LensChoice {
    const LensFamily* family = nullptr;
    std::vector<LensTrial> trials;
    std::vector<Bundle> cameras;  ///< solved with the chosen family, in the given order
};

/// Chooses the lens family by cross-validation. It calibrates all cameras (of one kind of lens)
/// with every family, each time without a fifth of the views, and measures the error of the
/// withheld views when only their boards' poses are solved. A lens that is too stiff fits them
/// badly, and so does one that follows the noise. Of the families within 1 % of the best, the one
/// with the fewest coefficients wins; families that diverge or fold the image are excluded. With
/// fewer than five views per camera, at most two radial coefficients are used. Throws Error if no
/// family leads to a calibration.
LensChoice choose_lens(const std::vector<CameraViews>& cameras);

/// Calibrates with a given family. Throws Error if it diverges.
LensChoice use_lens(const std::vector<CameraViews>& cameras, const LensFamily& family);

}  // namespace vantage
