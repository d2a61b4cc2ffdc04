#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib_tools/pictures/seen_picture.h"
#include "calib_tools/rig/lens_choice.h"
#include "calib_tools/rig/pair_solver.h"
#include "common/config/calibration_file.h"
#include "common/geometry/pair_aim.h"

namespace vantage {

/// Image or pair that was not used, and the reason, which completes a sentence that begins with its
/// name.
struct Refusal {
    std::string name, reason;
};

struct RigOptions {
    const LensFamily* family = nullptr;  ///< null: chosen by held-out error
    double alpha = 0;  ///< of the rectification: 0 keeps only valid pixels, 1 keeps all
    int rectified_width_px = 0, rectified_height_px = 0;  ///< 0: like the raw images
    std::optional<double> far_m = {};  ///< where the disparity is 0; empty: suitable_far_m()
};

struct CameraCalibration {
    Bundle bundle;  ///< camera 0; board i belongs to frame set i
    BundleUncertainty uncertainty;
    std::vector<LensTrial> trials;
    std::vector<std::string> names;  ///< of the frame sets
    std::vector<Refusal> rejected;
    std::vector<std::string> doubts;  ///< warnings, one sentence each
    std::vector<std::string> advice;  ///< images that would help, one sentence each
    std::size_t views_given = 0, views_used = 0, corners_left_out = 0;
    PrintedBoard printed;
};

struct RigCalibration {
    StereoCalibration calibration;
    Bundle bundle;  ///< camera 0 left, 1 right; board i belongs to frame set i
    BundleUncertainty uncertainty;
    std::vector<LensTrial> trials;
    std::vector<std::string> names;  ///< of the frame sets
    std::vector<Refusal> rejected;
    std::vector<std::string> doubts, advice;
    std::size_t views_given = 0, views_used = 0, corners_left_out = 0;
    PrintedBoard printed;
    double row_rms_px = 0, row_max_px = 0;
    double baseline_m = 0, baseline_sigma_m = 0;
    PairAim aim;
};

/// Calibrates one camera from a series of images. Throws Error, in one sentence, if they do not
/// give a trustworthy calibration.
CameraCalibration calibrate_camera(std::vector<SeenPicture> pictures, const BoardPattern& pattern,
                                   const RigOptions& options);

/// Calibrates a stereo rig from image pairs; both series have the same order. Throws Error like
/// calibrate_camera(), and for pairs that cannot be of one rig: swapped or mirrored sides, images
/// of different exposures, one camera given twice, or two resolutions.
RigCalibration calibrate_rig(std::vector<SeenPicture> left, std::vector<SeenPicture> right,
                             const BoardPattern& pattern, const RigOptions& options);

/// Uncertainties of a rig in the form that its file stores.
CalibrationSigma calibration_sigma(const RigCalibration& rig);
CalibrationSigma::Camera camera_sigma(const BundleUncertainty::Camera& camera);

}  // namespace vantage
