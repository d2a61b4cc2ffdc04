#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/calibration_forms/calibration_form.h"
#include "common/config/stage_cameras.h"
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

/// All cameras of a calibration, each with its place.
struct ImportedCameras {
    std::vector<SingleCamera> cameras;  ///< without sources
    std::string program;
    std::vector<std::string> taken, left_out, assumed;  ///< for the report
};

/// Imports every camera as a single camera of a stage. Names become valid as names of rigs. `up` is
/// the axis of the file's world that points up: x, y, z, -x, -y or -z; Vantage's is y. Throws Error
/// as import_calibration() does, and if the file does not say where a camera stands.
ImportedCameras import_cameras(std::span<const FormFile> files, const ImportSettings& settings,
                               const std::string& up);

/// Vertical agreement of a rectified image pair, in pixels of the rectified images.
struct RowAgreement {
    std::size_t features = 0;
    double median_px = 0, rms_px = 0;  ///< distances from the epipolar lines
    double offset_px = 0;  ///< median of the rows of the right image minus those of the left one
};
/// Rectifies the raw pair and tracks features along its rows. Throws Error for images of another
/// size, and if there are too few features to judge.
RowAgreement check_rows(const StereoCalibration& calibration, const ColourImage& raw_left,
                        const ColourImage& raw_right);

/// Corrects a constant offset between the rows of both images, such as one whole row, by moving the
/// principal point of the right camera, and rectifies again. Returns the offset in pixels of the
/// right raw image, positive if its rows were lower; empty, and nothing is changed, if the rows
/// agree or the offset does not explain their disagreement. `rows` is that of check_rows() and
/// becomes that of the result.
std::optional<double> correct_row_offset(StereoCalibration& calibration, double alpha,
                                         const ColourImage& raw_left, const ColourImage& raw_right,
                                         RowAgreement& rows);

}  // namespace vantage
