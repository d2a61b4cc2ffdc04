#pragma once

#include <array>
#include <span>
#include <string_view>

#include "common/geometry/camera_model.h"

namespace vantage {

/// Family of lens models: the subset of OpenCV's distortion coefficients that a calibration solves
/// for.
struct LensFamily {
    std::string_view name;
    LensModel lens;
    int stored_coefficients;   ///< length of CameraModel::distortion
    std::array<bool, 8> free;  ///< in OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6, fisheye k1 k2 k3 k4
    int free_count() const;
};

/// All families, from the stiffest to the most flexible. The held-out error chooses between them.
std::span<const LensFamily> lens_families();
/// Throws Error that lists the known names.
const LensFamily& lens_family(std::string_view name);

}  // namespace vantage
