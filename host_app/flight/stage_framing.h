#pragma once

#include <optional>
#include <span>
#include <string>

#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// One rig's camera, and how far away most of what it sees is.
struct FramedRig {
    std::string name;
    Pose world_from_camera = Pose::Identity();
    double field_of_view_rad = 0.785;
    double median_depth_m = 0;  ///< 0: it sees no depth
};

/// Where the virtual camera begins on a stage, and where it may go.
struct StageFraming {
    OrbitView start;
    FlightLimits limits;
    StageExtent extent;
};

/// The camera begins at the middle rig's place, with its pivot where the rigs' axes meet, or, if
/// they don't, on its axis at the depth of what it sees. Limits are those of a stage that is as
/// deep as the rigs see, and so is its extent: the floor is y = 0, or below the lowest rig where
/// one stands under that. Nothing without a rig that sees depth.
std::optional<StageFraming> frame_stage(std::span<const FramedRig> rigs);

}  // namespace vantage
