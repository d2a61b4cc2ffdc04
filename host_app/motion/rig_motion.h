#pragma once

#include <opencv2/core.hpp>

#include "common/wire/frame_message.h"

namespace vantage {

/// What moved between two frames of a rig, which stands still itself: optical flow both ways (DIS,
/// Kroeger et al. 2016) at up to 512 columns, and where it is to be trusted.
struct RigMotion {
    cv::Mat2f forward, backward;  ///< px of this grid: from a pixel of the first to where it is in
                                  ///< the second, and back
    cv::Mat1b is_sure_first, is_sure_second;  ///< not 0: both agree, of pixels of either frame
    /// Not 0: all stands still here, or most of what moves hereabouts is sure.
    cv::Mat1b is_followed;

    bool empty() const { return forward.empty(); }
};

/// Of frames with colour of one size; else empty.
RigMotion motion_between(const RigFrame& first, const RigFrame& second);

/// What the rig would have seen at `share` (0..1) of the time from `first` to `second`: colour and
/// disparity go along the motion, the nearest surface before others. Where none ends is what the
/// farther one of both frames shows there: a set stands still behind those who move. Where motion
/// is not followed all is as in the frame that is nearer in time. Precondition: the motion is
/// theirs, and not empty.
RigFrame frame_between(const RigFrame& first, const RigFrame& second, const RigMotion& motion,
                       double share);

}  // namespace vantage
