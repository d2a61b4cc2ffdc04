#pragma once

#include <vector>

#include "calib_tools/colour/overlap.h"

namespace vantage {

/// Feature of rig b's image and its distance from the epipolar line in rig a's image. The distance
/// comes from the rigs' poses, whatever the depth of the feature.
struct TrackedPlace {
    Eigen::Vector2d b_px;
    double miss_px = 0;
};

/// Tracks up to `most` corners of b's image in a's image: a's image is warped to b's view with b's
/// depth, and compared near the corner. The offset along the epipolar line belongs to the depth
/// measure, since an error of depth cannot be distinguished from one of pose there.
std::vector<TrackedPlace> track_places(const OverlapView& a, const OverlapView& b, int most);

}  // namespace vantage
