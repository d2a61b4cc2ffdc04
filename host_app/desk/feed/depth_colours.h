#pragma once

#include "common/image/image.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Depth of every pixel; 0 = unknown.
DepthImage depth_of(const DisparityImage& disparity, const DisparityScale& scale);

/// The depths that a picture of depth tells apart: those of the scene itself, without the nearest
/// and the farthest fiftieth. It follows slowly, so that colours keep their meaning from picture to
/// picture.
struct DepthRange {
    double nearest_m = 0, farthest_m = 0;  ///< 0: not known yet

    void follow(const DepthImage& depth);
};

/// For people: the nearest yellow, the farthest dark blue (cividis, which people who see few
/// colours read alike: J. Nuñez, C. Anderton, R. Renslow, 2018), even in the logarithm of depth;
/// unknown is black.
ColourImage depth_colours(const DepthImage& depth, const DepthRange& range);

}  // namespace vantage
