#pragma once

#include <opencv2/core.hpp>

#include "common/image/image.h"
#include "rig_firmware/stereo/disparity/perm_reference.h"

namespace vantage {

/// What the costs around a minimum look like over disparity, which decides how a sub-pixel position
/// comes from the three lowest.
enum class Valley {
    sharp,  ///< two straight lines of equal steepness, as absolute differences give
    flat,   ///< those of HalvedCostPass: the least of three disparities lies flat, then rises, so
            ///< that straight lines would meet too far from the middle
};

struct CheckedDisparity {
    DisparityImage disparity;  ///< 1/32 px; 0 = failed the check
    cv::Mat1b confidence;      ///< 0..255; 0 where unknown
};

/// CPU form of LeftRightPass, bit for bit.
CheckedDisparity left_right_checked(const Winners& winners, Valley valley = Valley::sharp);

}  // namespace vantage
