#pragma once

#include <cstdint>
#include <string>

#include "common/colour/colour_correction.h"
#include "common/geometry/pose.h"
#include "common/image/image.h"

namespace vantage {

/// What one rig (or one entry of a view set) knows of an instant: a picture with the depth of its
/// pixels.
struct DepthView {
    std::string name;
    ColourImage colour;
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();  ///< of the colour picture, px; may have skew
    Pose world_from_camera = Pose::Identity();
    /// z along this camera's axis, metres, 0 = unknown; of the colour's size, or a smaller one with
    /// the same field of view; empty: the view gives no geometry.
    DepthImage depth_m;
    /// Depth uncertainty of a pixel is z^2 * sigma / (f * baseline): baseline 0 where depth does
    /// not come of stereo.
    double baseline_m = 0;
    double doffs_px = 0;
    /// Brings the picture's colours to the stage's; done on the GPU on its way to the synthesisers.
    ColourCorrection colour_correction = {};
};

}  // namespace vantage
