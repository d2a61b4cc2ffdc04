#pragma once

#include <opencv2/core.hpp>

#include "common/geometry/stereo_calibration.h"

namespace vantage {

enum class Side { left, right };

/// For every rectified pixel the position (x, y in px, pixel centres at integers) in the raw
/// picture of that side, for any lens that OpenCV's models describe. Size: rectified.height_px x
/// rectified.width_px.
cv::Mat2f make_rectification_map(const StereoCalibration& calibration, Side side);

/// True if raw and rectified picture are the same (an already rectified source), so that the pass
/// can be left out.
bool is_identity(const StereoCalibration& calibration, Side side);

}  // namespace vantage
