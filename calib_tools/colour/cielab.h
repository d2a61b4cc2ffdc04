#pragma once

#include <cmath>

#include <Eigen/Core>

namespace vantage {

/// CIE L*a*b* (1976) of linear sRGB with white point D65; a template for derivatives. The linear
/// part below the range of the cube root also covers values slightly below 0.
template <class T>
Eigen::Matrix<T, 3, 1> lab_from_linear(const T& red, const T& green, const T& blue) {
    using std::cbrt;
    using std::pow;
    const auto f = [](const T& t) {
        return t > T(216.0 / 24389) ? pow(t, T(1.0 / 3)) : (T(24389.0 / 27) * t + T(16)) / T(116);
    };
    const T x = f((T(0.4124564) * red + T(0.3575761) * green + T(0.1804375) * blue) / T(0.95047));
    const T y = f(T(0.2126729) * red + T(0.7151522) * green + T(0.0721750) * blue);
    const T z = f((T(0.0193339) * red + T(0.1191920) * green + T(0.9503041) * blue) / T(1.08883));
    return {T(116) * y - T(16), T(500) * (x - y), T(200) * (y - z)};
}

/// CIE L*a*b* of a gamma-coded sRGB colour, 0 to 1.
Eigen::Vector3d lab_from_coded(const Eigen::Vector3d& coded);

/// Colour difference CIEDE2000 (Sharma, Wu, Dalal 2005); the eye can just see a difference of about
/// 1.
double delta_e_2000(const Eigen::Vector3d& lab_a, const Eigen::Vector3d& lab_b);

}  // namespace vantage
