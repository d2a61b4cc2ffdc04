#pragma once

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// From the colours of one camera to those of the stage:
///
///   stage = encode(matrix * decode(camera) ^ tone)
///
/// decode and encode are sRGB's transfer function and its inverse (IEC 61966-2-1), channel by
/// channel; tone is an exponent a channel, for cameras whose response is not quite sRGB's.
struct ColourCorrection {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
    Eigen::Vector3d tone = Eigen::Vector3d::Ones();

    bool is_identity() const {
        return matrix == Eigen::Matrix3d::Identity() && tone == Eigen::Vector3d::Ones();
    }
    bool operator==(const ColourCorrection& other) const {
        return matrix == other.matrix && tone == other.tone;
    }
    /// Throws Error naming what cannot be: tones outside 0.2 to 5, entries beyond 10, not finite.
    void validate() const;

    /// sRGB-coded R, G, B in 0 to 1, to the same; clamped.
    Eigen::Vector3d apply(const Eigen::Vector3d& coded) const;
    /// The reference of the pass on the GPU; alpha stays.
    ColourImage apply(const ColourImage& picture) const;
};

/// sRGB's transfer function for one channel, 0 to 1, and its inverse; template for derivatives.
template <class T>
T srgb_decode(const T& coded) {
    using std::pow;
    return coded <= T(0.04045) ? coded / T(12.92) : pow((coded + T(0.055)) / T(1.055), T(2.4));
}
template <class T>
T srgb_encode(const T& linear) {
    using std::pow;
    return linear <= T(0.0031308) ? linear * T(12.92)
                                  : T(1.055) * pow(linear, T(1 / 2.4)) - T(0.055);
}

}  // namespace vantage
