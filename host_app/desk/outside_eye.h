#pragma once

namespace vantage {

/// From where the operator looks at the stage from outside: around the middle of the performers.
struct OutsideEye {
    double azimuth_rad = 0.5, elevation_rad = 0.55;  ///< as OrbitView
    double nearness = 0;                             ///< 0: all rigs are seen; 1: e times nearer

    /// Keeps it above the floor, and the stage in sight.
    void turn(double azimuth_by_rad, double elevation_by_rad);
    void go_nearer(double by);
    bool operator==(const OutsideEye&) const = default;
};

}  // namespace vantage
