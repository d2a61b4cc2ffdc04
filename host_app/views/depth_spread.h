#pragma once

#include "host_app/views/depth_view.h"

namespace vantage {

/// Disparities are trusted to this many pixels.
inline constexpr double disparity_sigma_px = 0.15;

/// The relative uncertainty of a stereo rig's depth, per metre of depth; 0 where it is not known to
/// be stereo.
inline float depth_spread(const DepthView& camera) {
    const double f_baseline = camera.K(0, 0) * camera.baseline_m;
    return f_baseline > 0 ? static_cast<float>(disparity_sigma_px / f_baseline) : 0.0f;
}

}  // namespace vantage
