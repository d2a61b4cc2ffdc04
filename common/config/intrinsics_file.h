#pragma once

#include <filesystem>
#include <string>

#include "common/config/calibration_file.h"
#include "common/geometry/camera_model.h"

namespace vantage {

/// How a lens calibration was made.
struct IntrinsicsRecord {
    std::string date;  ///< ISO 8601
    std::string tool;
    double rms_px = 0;  ///< reprojection error
    int views_used = 0;
    CalibrationSigma::Camera sigma;
};

/// Loads an intrinsics file of one camera: YAML with version, units, date, residual, standard
/// deviations and a checksum, with the key names of OpenCV's calibration sample, so that its tools
/// can read it. Throws Error naming file and value if anything is missing or invalid.
CameraModel load_intrinsics(const std::filesystem::path& path);

/// Writes the file atomically. A valid earlier file is kept as PATH.last. Throws Error if the
/// camera is invalid, or the file cannot be written.
void save_intrinsics(const std::filesystem::path& path, const CameraModel& camera,
                     const IntrinsicsRecord& record);

}  // namespace vantage
