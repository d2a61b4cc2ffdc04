#pragma once

#include <filesystem>
#include <string>

#include "common/config/calibration_file.h"
#include "common/geometry/camera_model.h"

namespace vantage {

/// Facts about how a camera's lens was calibrated.
struct IntrinsicsRecord {
    std::string date;  ///< ISO 8601
    std::string tool;
    double rms_px = 0;  ///< reprojection
    int views_used = 0;
    CalibrationSigma::Camera sigma;
};

/// One camera's lens as YAML, with version, units, date, residual, deviations and a checksum over
/// the numbers, under the names that OpenCV's own calibration sample uses, so that its tools read
/// the file. Throws Error naming file and value for what is missing, damaged or impossible.
CameraModel load_intrinsics(const std::filesystem::path& path);

/// Writes atomically. A file that stood there before and is good is kept as PATH.last. Throws Error
/// if the camera is not valid, or the disk refuses.
void save_intrinsics(const std::filesystem::path& path, const CameraModel& camera,
                     const IntrinsicsRecord& record);

}  // namespace vantage
