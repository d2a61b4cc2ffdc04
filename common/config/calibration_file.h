#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/stereo_calibration.h"

namespace vantage {

/// Calibration files: YAML that cv::FileStorage reads, with version, units, date, residuals and a
/// checksum over the numbers. Throws Error naming file and value for what is missing, damaged, of
/// another version or impossible; a checksum that does not fit is an Error too.
StereoCalibration load_calibration(const std::filesystem::path& path);

/// One standard deviation of everything that was solved; 0 for what was held.
struct CalibrationSigma {
    struct Camera {
        double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
        std::vector<double> distortion;  ///< as many as the camera has coefficients
    };
    Camera left, right;
    Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< of right_from_left
    Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
};

/// Facts about how it was made, kept in the file for people and for `check`.
struct CalibrationRecord {
    std::string date;  ///< ISO 8601
    std::string tool;
    double rms_px = 0;      ///< reprojection
    double row_rms_px = 0;  ///< row difference after rectification
    int views_used = 0;
    double alpha = 0;  ///< of the rectification, as compute_rectification takes it
    std::optional<CalibrationSigma> sigma = {};
};

/// The record of a calibration file; throws as load_calibration does.
CalibrationRecord load_calibration_record(const std::filesystem::path& path);

/// The name of a calibration: 16 hexadecimal digits of the checksum (FNV-1a, 64 bits) over the
/// numbers of its geometry in their order of the file. Calibrations with equal numbers have equal
/// names. (A file's own checksum is over its residuals and uncertainties too.)
std::string calibration_checksum(const StereoCalibration& calibration);

/// Writes atomically; the id is made from the content. A file that stood there before and is good
/// is kept as PATH.last. Throws Error if the calibration is not valid, or the disk refuses.
void save_calibration(const std::filesystem::path& path, StereoCalibration calibration,
                      const CalibrationRecord& record);

}  // namespace vantage
