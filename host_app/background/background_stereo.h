#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include <Eigen/Core>

#include "common/base/shared_bytes.h"
#include "common/colour/colour_correction.h"
#include "common/geometry/pose.h"
#include "common/image/image.h"

namespace vantage {

/// What one rig has learnt of its set. Both pictures have one size.
struct BackgroundView {
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    Pose world_from_camera = Pose::Identity();
    double baseline_m = 0;  ///< of the rig's own two cameras
    ColourImage colour;     ///< alpha 0: the set is not known there
    DepthImage depth_m;     ///< of the rig's own matcher, 0 = unknown
    /// The rig's rectified right pictures, as they came; of one size, which has the same field of
    /// view. Where there are fewer than three the set is matched without.
    std::vector<SharedBytes> right_jpegs = {};
    cv::Size right_px = {};
    ColourCorrection right_correction = {};  ///< brings their colours to the stage's
    double doffs_px = 0;                     ///< their cx is so much more, pixels of `colour`
};

/// Matches the sets of rigs against each other. A stereo rig's baseline is short, and its matcher
/// works against time; a set stands still, its colours are free of noise, and other rigs look at it
/// from metres aside. So every depth of the stage is tried at every pixel (a plane sweep, Collins
/// 1996): its cost is how unlike the pictures of the two rigs are that are most like this one's
/// there, how unlike the rig's own right picture is, which tells apart what stands alike in a row
/// and sees what no other rig does, and how far it is from the depth of the rig's own matcher.
/// Surfaces are found by semi-global matching (Hirschmueller, 2008) over these costs. That is done
/// twice: the second time each rig's depths tell the others what is hidden from it, what it sees
/// through, and what it agrees with.
///
/// Takes 1 s a rig of 320x240 on one thread, and 150 MB.
///
/// @return each rig's depth, metres, 0 where its set is not known, or where no other rig stands
/// farther from it than its own two cameras from each other; nothing if `stop` was asked for.
std::optional<std::vector<DepthImage>> match_backgrounds(std::span<const BackgroundView> sets,
                                                         const std::stop_token& stop = {});

}  // namespace vantage
