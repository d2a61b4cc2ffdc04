#pragma once

#include <chrono>
#include <numbers>
#include <string>

#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/views/depth_view.h"

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

/// Returns the picture of the left camera of an ideal rig, with exact depth.
inline DepthView exact_view_at(VirtualStage& stage, double azimuth_deg, int width_px, int height_px,
                               std::chrono::nanoseconds time = stage_time) {
    const StageCamera camera = camera_at(azimuth_deg, width_px, height_px);
    StageRendering seen = stage.render(camera, time);
    return {.name = std::to_string(azimuth_deg),
            .colour = seen.colour,
            .K = camera.K,
            .world_from_camera = camera.world_from_camera,
            .depth_m = seen.depth_m,
            .baseline_m = VirtualRigPlacement{}.baseline_m,
            .doffs_px = 0};
}

}  // namespace vantage
