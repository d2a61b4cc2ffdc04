#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "common/wire/frame_message.h"

namespace vantage {

/// What moved between two frames of a rig, which stands still itself: optical flow both ways (DIS,
/// Kroeger et al. 2016) at up to 512 columns, where something moves, and where it is to be trusted.
struct RigMotion {
    cv::Mat2f forward, backward;  ///< px of this grid: from a pixel of the first to where it is in
                                  ///< the second, and back
    cv::Mat1b is_sure_first, is_sure_second;  ///< not 0: both agree, of pixels of either frame
    /// Not 0: all stands still here, or most of what moves hereabouts is sure.
    cv::Mat1b is_followed;

    cv::Mat1i region;  ///< of pixels that move, and those close to them; 0: of none
    int regions = 0;   ///< numbers that there are, with 0

    bool empty() const { return forward.empty(); }
};

/// Of frames with colour of one size; else empty.
RigMotion motion_between(const RigFrame& first, const RigFrame& second);

/// Nothing of these regions is followed any more.
void leave_alone(RigMotion& motion, const std::vector<int>& regions);

}  // namespace vantage
