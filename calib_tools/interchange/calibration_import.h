#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/calibration_forms/calibration_form.h"
#include "common/image/image.h"

namespace vantage {

struct ImportSettings {
    std::string left = {}, right = {};  ///< names of the cameras of the rig; empty: found out
    double metres_per_unit = 0;  ///< of the file's lengths; 0: as the form defines, else metres
    double baseline_m = 0;       ///< measured between the cameras: sets the scale; 0: not stated
    double alpha = 0;            ///< of the rectification, as compute_rectification takes it
    FormSettings form = {};
};

struct ImportedCalibration {
    std::optional<StereoCalibration> rig;               ///< empty: the files hold one camera
    CameraModel camera;                                 ///< the only one, or the left one
    std::string program;                                ///< whose form it was
    std::vector<std::string> taken, left_out, assumed;  ///< for people
};

/// Makes a rig of two cameras of another program's calibration, or one camera where the files hold
/// only one. The rectification is new, and the rig's place is assumed. Throws Error for files that
/// no form knows, and where it is open which cameras are meant, how long a unit is or how large the
/// pictures are, with the option that says it.
ImportedCalibration import_calibration(std::span<const FormFile> files,
                                       const ImportSettings& settings);

/// How well the rows of a rectified pair agree, in pixels of the rectified pictures.
struct RowAgreement {
    std::size_t features = 0;
    double median_px = 0, rms_px = 0;  ///< of the distances from the epipolar lines
};
/// Rectifies the raw pair and follows features along its rows. Throws Error for pictures of another
/// size, and where too few features are found to judge.
RowAgreement check_rows(const StereoCalibration& calibration, const ColourImage& raw_left,
                        const ColourImage& raw_right);

}  // namespace vantage
