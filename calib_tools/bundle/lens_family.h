#pragma once

#include <array>
#include <span>
#include <string_view>

#include "common/geometry/camera_model.h"

namespace vantage {

/// How much freedom a calibration gives a lens: which of OpenCV's coefficients may leave zero.
struct LensFamily {
    std::string_view name;
    LensModel lens;
    int stored_coefficients;   ///< length of CameraModel::distortion
    std::array<bool, 8> free;  ///< by OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6, fisheye k1 k2 k3 k4
    int free_count() const;
};

/// From the stiffest to the softest. No calibration has to be told which fits: held-out error says.
std::span<const LensFamily> lens_families();
/// Throws Error with the names that there are.
const LensFamily& lens_family(std::string_view name);

}  // namespace vantage
