#pragma once

#include <Eigen/Core>

namespace vantage {

/// The geometry of a rectified pair: both cameras share f, cy and orientation; the right one stands
/// baseline_m along +x. Disparity is left-referenced, positive: x_right = x_left - d.
struct RectifiedStereo {
    int width_px = 0, height_px = 0;
    double f_px = 0;
    double cx_left_px = 0, cx_right_px = 0, cy_px = 0;
    double baseline_m = 0;

    double doffs_px() const { return cx_right_px - cx_left_px; }
    Eigen::Matrix3d K_left() const;

    /// z = f * baseline / (d + doffs), metres; 0 (unknown) where d + doffs <= 0.
    double depth_m(double disparity_px) const;
    /// d = f * baseline / z - doffs; precondition z > 0.
    double disparity_px(double depth_m) const;
};

}  // namespace vantage
