#pragma once

#include <Eigen/Core>

namespace vantage {

/// The geometry of a rectified stereo pair. Both cameras share the focal length, cy and
/// orientation; the right camera is at baseline_m along +x. Disparity is left-referenced and
/// positive: x_right = x_left - d.
struct RectifiedStereo {
    int width_px = 0, height_px = 0;
    double f_px = 0;
    double cx_left_px = 0, cx_right_px = 0, cy_px = 0;
    double baseline_m = 0;

    double doffs_px() const { return cx_right_px - cx_left_px; }
    Eigen::Matrix3d K_left() const;

    /// Depth from disparity: z = f * baseline / (d + doffs) in metres; 0 (unknown) if d + doffs <=
    /// 0.
    double depth_m(double disparity_px) const;
    /// Disparity from depth: d = f * baseline / z - doffs; precondition: z > 0.
    double disparity_px(double depth_m) const;
};

}  // namespace vantage
