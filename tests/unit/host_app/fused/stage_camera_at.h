#pragma once

#include <chrono>
#include <numbers>

#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"

namespace vantage {

/// When synthesisers look at the virtual stage.
inline constexpr std::chrono::seconds stage_time{2};

/// The left camera of an ideal rig that stands there.
inline StageCamera camera_at(double azimuth_deg, int width_px, int height_px) {
    const StereoCalibration rig =
        ideal_virtual_rig({.azimuth_rad = azimuth_deg * std::numbers::pi / 180,
                           .width_px = width_px,
                           .height_px = height_px});
    return {width_px, height_px, rig.left.K(), rig.world_from_left};
}

}  // namespace vantage
