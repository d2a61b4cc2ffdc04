#pragma once

#include <filesystem>

#include "common/geometry/stereo_calibration.h"

namespace vantage {

/// Calibration files: YAML that cv::FileStorage reads, with version, units, date, residuals and a
/// checksum over the numbers. Throws Error naming file and value for what is missing, damaged, of
/// another version or impossible; a checksum that does not fit is an Error too.
StereoCalibration load_calibration(const std::filesystem::path& path);

/// Facts about how it was made, kept in the file for people and for `check`.
struct CalibrationRecord {
    std::string date;  ///< ISO 8601
    std::string tool;
    double rms_px = 0;      ///< reprojection
    double row_rms_px = 0;  ///< row difference after rectification
    int views_used = 0;
};

/// Writes atomically; the file that stood there before is kept as PATH.last.
void save_calibration(const std::filesystem::path& path, StereoCalibration calibration,
                      const CalibrationRecord& record);

}  // namespace vantage
