#include "common/geometry/rectified_stereo.h"

#include <cassert>

namespace vantage {

Eigen::Matrix3d RectifiedStereo::K_left() const {
    Eigen::Matrix3d k;
    k << f_px, 0, cx_left_px, 0, f_px, cy_px, 0, 0, 1;
    return k;
}

double RectifiedStereo::depth_m(double disparity_px) const {
    const double total = disparity_px + doffs_px();
    return total > 0 ? f_px * baseline_m / total : 0;
}

double RectifiedStereo::disparity_px(double depth_m) const {
    assert(depth_m > 0);
    return f_px * baseline_m / depth_m - doffs_px();
}

}  // namespace vantage
