#pragma once

#include <vector>

#include "calib_tools/colour/overlap.h"

namespace vantage {

/// A feature of rig b's picture and how far rig a shows it beside the line on which the two rigs'
/// places put it, whatever its depth (the distance from its epipolar line).
struct TrackedPlace {
    Eigen::Vector2d b_px;
    double miss_px = 0;
};

/// Follows up to `most` corners of b's picture into a's: a's picture is drawn as b would see it, by
/// b's depth, and compared near the corner. What lies along the epipolar line is left to the depth
/// measure, since there an error of depth cannot be told from one of place.
std::vector<TrackedPlace> track_places(const OverlapView& a, const OverlapView& b, int most);

}  // namespace vantage
