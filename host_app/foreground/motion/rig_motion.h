#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "common/wire/frame_message.h"

namespace vantage {

/// The motion between two frames of a rig, which stands still itself: optical flow in both
/// directions (DIS, Kroeger et al., 2016) at up to 512 columns, and where it is reliable.
struct RigMotion {
    cv::Mat2f forward, backward;  ///< px of this grid: from a pixel of the first frame to its
                                  ///< place in the second, and back
    cv::Mat1b is_sure_first, is_sure_second;  ///< not 0: both flows are consistent
    /// Not 0: nothing moves here, or most of the moving region is reliable.
    cv::Mat1b is_followed;

    cv::Mat1i region;  ///< region of moving pixels and those near them; 0: none
    int regions = 0;   ///< count of region numbers, including 0

    bool empty() const { return forward.empty(); }
};

/// Computes the motion between two frames. Empty unless both have colour of the same size.
RigMotion motion_between(const RigFrame& first, const RigFrame& second);

/// Marks these regions as not followed: they show the frame that is nearer in time.
void leave_alone(RigMotion& motion, const std::vector<int>& regions);

}  // namespace vantage
