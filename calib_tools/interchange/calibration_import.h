#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/calibration_forms/calibration_form.h"
#include "common/image/image.h"

namespace vantage {

struct ImportSettings {
    std::string left = {}, right = {};  ///< names of the rig's cameras; empty: detected
    double metres_per_unit =
        0;  ///< unit of the file's lengths; 0: as the format defines, else metres
    double baseline_m =
        0;             ///< measured distance of the cameras, which sets the scale; 0: not given
    double alpha = 0;  ///< of the rectification, see compute_rectification()
    FormSettings form = {};
};

struct ImportedCalibration {
    std::optional<StereoCalibration> rig;               ///< empty if the files hold one camera
    CameraModel camera;                                 ///< the only camera, or the left one
    std::string program;                                ///< program that defines the format
    std::vector<std::string> taken, left_out, assumed;  ///< for the report
};

/// Imports two cameras of another program's calibration as a rig, or one camera if the files hold
/// only one. The rectification is new, and the rig's pose is assumed. Throws Error for files in no
/// known format. Throws Error, with the option that answers the question, if the cameras, the unit
/// or the image size are ambiguous.
ImportedCalibration import_calibration(std::span<const FormFile> files,
                                       const ImportSettings& settings);

/// Vertical agreement of a rectified image pair, in pixels of the rectified images.
struct RowAgreement {
    std::size_t features = 0;
    double median_px = 0, rms_px = 0;  ///< distances from the epipolar lines
};
/// Rectifies the raw pair and tracks features along its rows. Throws Error for images of another
/// size, and if there are too few features to judge.
RowAgreement check_rows(const StereoCalibration& calibration, const ColourImage& raw_left,
                        const ColourImage& raw_right);

}  // namespace vantage
