#pragma once

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// A colour correction from a camera's colours to the stage's colours:
///
///   stage = encode(matrix * decode(camera) ^ tone)
///
/// decode and encode are sRGB's transfer function and its inverse (IEC 61966-2-1) per channel. tone
/// is one exponent per channel, for cameras whose response differs slightly from sRGB.
struct ColourCorrection {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
    Eigen::Vector3d tone = Eigen::Vector3d::Ones();

    bool is_identity() const {
        return matrix == Eigen::Matrix3d::Identity() && tone == Eigen::Vector3d::Ones();
    }
    bool operator==(const ColourCorrection& other) const {
        return matrix == other.matrix && tone == other.tone;
    }
    /// Throws Error naming a value outside its range: tones 0.2 to 5, matrix entries -10 to 10.
    void validate() const;

    /// Corrects one sRGB colour; R, G and B are in 0 to 1 and clamped to it.
    Eigen::Vector3d apply(const Eigen::Vector3d& coded) const;
    /// Corrects an image on the CPU; alpha stays. Reference for ColourPass.
    ColourImage apply(const ColourImage& picture) const;
};

/// sRGB's transfer function for one channel, 0 to 1, and its inverse. Templates, so that a solver
/// can take derivatives.
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
