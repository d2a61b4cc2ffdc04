#pragma once

#include <string>
#include <vector>

#include "calib_tools/colour/colour_match.h"
#include "common/geometry/pose.h"
#include "common/image/image.h"

namespace vantage {

/// Image of one rig with the depth of its pixels.
struct OverlapView {
    std::string name;
    ColourImage colour;
    DepthImage depth_m;  ///< of the image's size; 0 = unknown
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    Pose world_from_camera = Pose::Identity();
    double baseline_m = 0;  ///< 0: the depth is not from stereo
};

/// Surface point of rig a that is visible in rig b's image.
struct OverlapSample {
    int a = 0, b = 0;
    Eigen::Vector2d a_px, b_px;
    double predicted_m = 0;  ///< depth in b, computed from a's depth
    double measured_m = 0;   ///< depth in b, measured by b
    double disparity_miss =
        0;  ///< the same difference in pixels of b's disparity; needs b's baseline
    ColourPair colours;
};

/// Samples of all ordered pairs of views, spread evenly over a's image, at most `most` per pair.
/// Places near depth edges or with strong texture in either image are left out, since a fraction of
/// a pixel decides there. Places at which b sees something more than 15 % nearer are left out too.
std::vector<OverlapSample> overlap_samples(const std::vector<OverlapView>& views, int most);

/// Samples whose two depths agree within 2 %, so that they certainly show one surface.
std::vector<ColourPair> same_surface(const std::vector<OverlapSample>& samples);

}  // namespace vantage
