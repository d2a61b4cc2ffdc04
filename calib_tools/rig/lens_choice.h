#pragma once

#include <string>
#include <vector>

#include "calib_tools/rig/camera_solver.h"

namespace vantage {

/// One candidate in the choice of a lens family.
struct LensTrial {
    const LensFamily* family = nullptr;
    double held_out_rms_px = 0;  ///< on views that took no part in the calibration
    std::string excluded;        ///< why it cannot be chosen; empty if it can
};

struct LensChoice {
    const LensFamily* family = nullptr;
    std::vector<LensTrial> trials;
    std::vector<Bundle> cameras;  ///< solved with the chosen family, in the order given
};

/// Calibrates all cameras (of one kind of lens) with every family, each time withholding a fifth of
/// the views, and sees how well the withheld views fit when only their boards' poses are solved:
/// too stiff a lens fits them badly, and so does one that bends with the noise. Of the families
/// within a hundredth of the best the one with the fewest coefficients wins; one that diverges or
/// folds the picture is out. With fewer than five views a camera, two radial coefficients are used
/// at most. Throws Error if no family leads to a calibration.
LensChoice choose_lens(const std::vector<CameraViews>& cameras);

/// The calibrations with a family that the user insists on. Throws Error if it diverges.
LensChoice use_lens(const std::vector<CameraViews>& cameras, const LensFamily& family);

}  // namespace vantage
