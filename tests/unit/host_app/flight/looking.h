#pragma once

#include <numbers>

#include "host_app/flight/orbit_view.h"

namespace vantage {

inline constexpr double deg = std::numbers::pi / 180;

/// Views on one orbit, which differ in azimuth only.
inline OrbitView looking(double azimuth_rad) {
    OrbitView view;
    view.azimuth_rad = azimuth_rad;
    return view;
}

}  // namespace vantage
