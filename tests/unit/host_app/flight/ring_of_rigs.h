#pragma once

#include <cmath>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <vector>

#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// A view of the middle of the stage, (0, 1, 0), from a distance of 4.5 m by default.
inline OrbitView view_at(double azimuth_deg, double elevation_deg = 10, double distance_m = 4.5) {
    constexpr double rad = std::numbers::pi / 180;
    return {.azimuth_rad = azimuth_deg * rad,
            .elevation_rad = elevation_deg * rad,
            .distance_m = distance_m};
}

/// The corridor of rigs on a circle of 4.5 m around the stage, with a field of view of 50 degrees
/// at 4:3. The virtual camera has 16:9.
inline std::shared_ptr<const Corridor> corridor_of(std::initializer_list<double> azimuths_deg) {
    std::vector<CorridorRig> rigs;
    const double half_width = std::tan(0.5 * 50 * std::numbers::pi / 180);
    for (const double azimuth_deg : azimuths_deg)
        rigs.push_back({view_at(azimuth_deg).world_from_camera(), half_width, 0.75 * half_width});
    return std::make_shared<const Corridor>(
        rigs, StageExtent{.centre_m = {0, 1, 0}, .radius_m = 1.8, .background_m = 3.6}, 9.0 / 16);
}

}  // namespace vantage
