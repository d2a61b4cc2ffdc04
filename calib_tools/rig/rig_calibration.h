#pragma once

#include <string>
#include <utility>
#include <vector>

#include "calib_tools/pictures/seen_picture.h"
#include "calib_tools/rig/lens_choice.h"
#include "calib_tools/rig/pair_solver.h"
#include "common/config/calibration_file.h"

namespace vantage {

/// A picture or pair that was not used, and why, as the rest of a sentence that begins with its
/// name.
struct Refusal {
    std::string name, reason;
};

struct RigOptions {
    const LensFamily* family = nullptr;  ///< null: chosen by held-out error
    double alpha = 0;                    ///< of the rectification: 0 only valid pixels, 1 all
    int rectified_width_px = 0, rectified_height_px = 0;  ///< 0: as the raw pictures
};

struct CameraCalibration {
    Bundle bundle;  ///< camera 0; board i belongs to instant i
    BundleUncertainty uncertainty;
    std::vector<LensTrial> trials;
    std::vector<std::string> names;  ///< of the instants
    std::vector<Refusal> rejected;
    std::vector<std::string> doubts;  ///< reasons not to trust it, a sentence each
    std::vector<std::string> advice;  ///< which pictures would help, a sentence each
    std::size_t views_given = 0, views_used = 0, corners_left_out = 0;
    PrintedBoard printed;
};

struct RigCalibration {
    StereoCalibration calibration;
    Bundle bundle;  ///< camera 0 left, 1 right; board i belongs to instant i
    BundleUncertainty uncertainty;
    std::vector<LensTrial> trials;
    std::vector<std::string> names;  ///< of the instants
    std::vector<Refusal> rejected;
    std::vector<std::string> doubts, advice;
    std::size_t views_given = 0, views_used = 0, corners_left_out = 0;
    PrintedBoard printed;
    double row_rms_px = 0, row_max_px = 0;
    double baseline_m = 0, baseline_sigma_m = 0;
};

/// One camera from a series of pictures. Throws Error, in one sentence, if they do not make a
/// calibration that can be trusted.
CameraCalibration calibrate_camera(std::vector<SeenPicture> pictures, const BoardPattern& pattern,
                                   const RigOptions& options);

/// A stereo rig from pictures that were taken in pairs; both series in the same order. Throws Error
/// as calibrate_camera does, and for pairs that cannot be of one rig: swapped or mirrored sides,
/// pictures that are not of the same instant, one camera given twice, two resolutions.
RigCalibration calibrate_rig(std::vector<SeenPicture> left, std::vector<SeenPicture> right,
                             const BoardPattern& pattern, const RigOptions& options);

/// The uncertainties of a rig as its file keeps them.
CalibrationSigma calibration_sigma(const RigCalibration& rig);
CalibrationSigma::Camera camera_sigma(const BundleUncertainty::Camera& camera);

}  // namespace vantage
