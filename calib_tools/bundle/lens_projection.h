#pragma once

#include <cmath>

#include "common/geometry/camera_model.h"

namespace vantage {

/// Number of lens parameters: fx, fy, cx, cy, then eight distortion coefficients.
inline constexpr int lens_parameter_count = 12;

/// Projects a point in camera coordinates, z > 0, with OpenCV's pinhole (k1 k2 p1 p2 k3 k4 k5 k6)
/// or fisheye (k1 .. k4) model. A template for plain and for automatically differentiated numbers.
template <class T>
void project_through_lens(LensModel lens, const T* p, const T& x, const T& y, const T& z,
                          T* pixel) {
    using std::atan2;
    using std::sqrt;
    const T a = x / z, b = y / z, r2 = a * a + b * b;
    const T* k = p + 4;
    if (lens == LensModel::fisheye) {
        const T r = sqrt(r2 + T(1e-16));
        const T theta = atan2(r, T(1)), t2 = theta * theta;
        const T scale = theta * (T(1) + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))) / r;
        pixel[0] = p[0] * a * scale + p[2];
        pixel[1] = p[1] * b * scale + p[3];
        return;
    }
    const T radial = (T(1) + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) /
                     (T(1) + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
    const T ab = a * b;
    pixel[0] = p[0] * (a * radial + T(2) * k[2] * ab + k[3] * (r2 + T(2) * a * a)) + p[2];
    pixel[1] = p[1] * (b * radial + k[2] * (r2 + T(2) * b * b) + T(2) * k[3] * ab) + p[3];
}

}  // namespace vantage
