#pragma once

#include <opencv2/core.hpp>

#include "common/geometry/stereo_calibration.h"

namespace vantage {

enum class Side { left, right };

/// The position in the raw image (x, y in px, pixel centres at integers) of every pixel of an ideal
/// camera in the same place, with this rotation, matrix and size.
cv::Mat2f make_undistortion_map(const CameraModel& camera, const Eigen::Matrix3d& ideal_from_camera,
                                const Eigen::Matrix3d& K, cv::Size size);

/// The position in the raw image of every rectified pixel
/// of one side, for any lens model. Size: rectified.height_px x rectified.width_px.
cv::Mat2f make_rectification_map(const StereoCalibration& calibration, Side side);

/// Whether the raw image equals the rectified one (an already rectified source), so that the pass
/// can be skipped.
bool is_identity(const StereoCalibration& calibration, Side side);

}  // namespace vantage
