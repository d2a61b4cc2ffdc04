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

/// One rig's background, as input of background stereo. Colour and depth have one size.
struct BackgroundView {
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    Pose world_from_camera = Pose::Identity();
    double baseline_m = 0;  ///< of the rig's own two cameras
    ColourImage colour;     ///< alpha 0: the background is unknown there
    DepthImage depth_m;     ///< from the rig's own matcher, 0 = unknown
    /// The rig's rectified right images, all of one size, with the field of view of `colour`. With
    /// fewer than three, they are not used.
    std::vector<SharedBytes> right_jpegs = {};
    cv::Size right_px = {};
    ColourCorrection right_correction = {};  ///< of the right images
    double doffs_px = 0;                     ///< their cx less that of `colour`, px of `colour`
};

enum class MatchedSize {
    half,   ///< an eighth of the time, with errors between those of the matchers and of `whole`
    whole,  ///< the views' own
};

/// Background stereo: multi-view stereo over the backgrounds of several rigs. A stereo rig's
/// baseline is short and its matcher works in real time; the background stands still, its colours
/// are free of noise, and other rigs see it from metres to the side. So every depth of the stage is
/// tried at every pixel (plane sweep; Collins, 1996). The cost of a depth combines the two other
/// rigs whose pictures match best, the rig's own right image, which resolves repetitive structure
/// and surfaces that no other rig sees, and the distance from the depth of the rig's own matcher.
/// Semi-global matching (Hirschmueller, 2008) selects surfaces from these costs. A second pass uses
/// the depths of the first for occlusions and consistency between rigs.
///
/// Takes 1 s for each rig of 320x240 on one thread, and 150 MB.
///
/// @return each rig's depth, metres; 0 where its background is unknown, or everywhere if no other
/// rig
///     stands farther away than twice its baseline. Nothing if `stop` was requested.
std::optional<std::vector<DepthImage>> match_backgrounds(std::span<const BackgroundView> views,
                                                         MatchedSize size,
                                                         const std::stop_token& stop = {});

}  // namespace vantage
