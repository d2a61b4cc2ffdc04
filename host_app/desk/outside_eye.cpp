#include "host_app/desk/outside_eye.h"

#include <algorithm>

namespace vantage {
namespace {

constexpr double least_elevation_rad = 0.02, most_elevation_rad = 1.5;
constexpr double least_nearness = -0.7, most_nearness = 2;

}  // namespace

void OutsideEye::turn(double azimuth_by_rad, double elevation_by_rad) {
    azimuth_rad += azimuth_by_rad;
    elevation_rad =
        std::clamp(elevation_rad + elevation_by_rad, least_elevation_rad, most_elevation_rad);
}

void OutsideEye::go_nearer(double by) {
    nearness = std::clamp(nearness + by, least_nearness, most_nearness);
}

}  // namespace vantage
