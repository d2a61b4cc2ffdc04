#pragma once

#include <opencv2/core.hpp>

#include "common/image/image.h"
#include "rig_firmware/stereo/disparity/left_right_pass.h"
#include "tests/references/stereo/perm_reference.h"

namespace vantage {

struct CheckedDisparity {
    DisparityImage disparity;  ///< 1/32 px; 0 = failed the check
    cv::Mat1b confidence;      ///< 0..255; 0 where unknown
};

/// CPU reference of LeftRightPass, bit for bit.
CheckedDisparity left_right_checked(const Winners& winners, Valley valley = Valley::sharp);

}  // namespace vantage
