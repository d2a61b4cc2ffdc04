#pragma once

#include <algorithm>
#include <vector>

#include <opencv2/core.hpp>

#include "common/wire/frame_message.h"

namespace vantage {

/// Disparity difference from which on two pixels belong to two surfaces, 1/32 px. Motion from pulse
/// to pulse and matching errors stay below it.
constexpr int one_surface_steps = 48;

/// Returns the pixel of another grid over the same image.
inline cv::Point on_grid(int x, int y, cv::Size size, cv::Size grid) {
    return {std::min((2 * x + 1) * grid.width / (2 * size.width), grid.width - 1),
            std::min((2 * y + 1) * grid.height / (2 * size.height), grid.height - 1)};
}

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

/// Interpolates the rig's frame at `share` (0..1) of the time from `first` to `second`. Colour and
/// disparity move along the motion; nearer surfaces hide farther ones, and a pixel belongs to a
/// surface that covers half of it. Pixels that no surface moves to show the farther surface of the
/// two frames, since the background stands still. Where motion is not followed, the result is the
/// frame that is nearer in time. Precondition: the motion is that of the two frames and not empty.
RigFrame frame_between(const RigFrame& first, const RigFrame& second, const RigMotion& motion,
                       double share);

}  // namespace vantage
