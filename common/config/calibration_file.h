#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/stereo_calibration.h"

namespace vantage {

/// Loads a calibration file: YAML of cv::FileStorage with version, units, date, residuals and a
/// checksum of the numbers. Throws Error naming file and value if anything is missing, invalid, of
/// another version, or does not match the checksum.
StereoCalibration load_calibration(const std::filesystem::path& path);

/// The standard deviation of every solved parameter; 0 for fixed ones.
struct CalibrationSigma {
    struct Camera {
        double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
        std::vector<double> distortion;  ///< one per distortion coefficient
    };
    Camera left, right;
    Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< of right_from_left
    Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
};

/// How a calibration was made, for people and for `vantage-calib check`.
struct CalibrationRecord {
    std::string date;  ///< ISO 8601
    std::string tool;
    double rms_px = 0;      ///< reprojection error
    double row_rms_px = 0;  ///< row difference after rectification
    int views_used = 0;
    double alpha = 0;  ///< of compute_rectification()
    std::optional<CalibrationSigma> sigma = {};
};

/// The record of a calibration file. Throws like load_calibration().
CalibrationRecord load_calibration_record(const std::filesystem::path& path);

/// The id of a calibration: 16 hexadecimal digits of the checksum (FNV-1a, 64 bits) over the
/// numbers of its geometry in the order of the file. Equal geometry has equal ids. (A file's own
/// checksum also covers residuals and uncertainties.)
std::string calibration_checksum(const StereoCalibration& calibration);

/// Writes the file atomically, with the id of its content. A valid earlier file is kept as
/// PATH.last. Throws Error if the calibration is invalid, or the file cannot be written.
void save_calibration(const std::filesystem::path& path, StereoCalibration calibration,
                      const CalibrationRecord& record);

}  // namespace vantage
