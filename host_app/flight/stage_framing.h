#pragma once

#include <optional>
#include <span>
#include <string>

#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// Pose and lens of one rig's camera, and the median of the depth that it measures.
struct FramedRig {
    std::string name;
    Pose world_from_camera = Pose::Identity();
    double field_of_view_rad = 0.785;
    double median_depth_m = 0;  ///< 0: no depth
};

/// Start view, limits and extent of a stage.
struct StageFraming {
    OrbitView start;
    FlightLimits limits;
    StageExtent extent;
};

/// Derives start view, limits and extent of a stage from its rigs. The camera starts at the middle
/// rig, with the pivot where the rigs' optical axes meet; if they do not meet, on its axis at its
/// median depth. Limits and extent are multiples of the largest median depth. The floor is y = 0,
/// or lies below the lowest rig if a rig stands lower. Empty if no rig has depth.
std::optional<StageFraming> frame_stage(std::span<const FramedRig> rigs);

}  // namespace vantage
