#pragma once

#include <string>
#include <vector>

#include "calib_tools/colour/colour_match.h"
#include "common/geometry/pose.h"
#include "common/image/image.h"

namespace vantage {

/// What one rig sees of an instant: a picture with the depth of its pixels.
struct OverlapView {
    std::string name;
    ColourImage colour;
    DepthImage depth_m;  ///< of the picture's size; 0 = unknown
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    Pose world_from_camera = Pose::Identity();
    double baseline_m = 0;  ///< 0: depth does not come of stereo
};

/// A surface point of rig a that lies in rig b's picture.
struct OverlapSample {
    int a = 0, b = 0;
    Eigen::Vector2d a_px, b_px;
    double predicted_m = 0;     ///< depth in b by a's depth
    double measured_m = 0;      ///< depth in b by b's own
    double disparity_miss = 0;  ///< the same difference in px of b's disparity; needs its baseline
    ColourPair colours;
};

/// Samples of all ordered pairs of views, spread evenly over a's picture, at most `most` a pair.
/// Left out: places near depth edges or with strong texture in either picture, where a fraction of
/// a pixel decides, and places that b sees something nearer before (by more than 15 %).
std::vector<OverlapSample> overlap_samples(const std::vector<OverlapView>& views, int most);

/// Those whose two depths agree within 2 %, which show one surface for sure.
std::vector<ColourPair> same_surface(const std::vector<OverlapSample>& samples);

}  // namespace vantage
