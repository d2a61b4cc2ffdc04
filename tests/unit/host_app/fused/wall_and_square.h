#pragma once

#include <cmath>
#include <string>

#include "host_app/views/depth_view.h"

namespace vantage {

struct WallAndSquare {
    double square_x_m = 0;  ///< where the square's middle is
    bool waves = false;     ///< on the wall, which otherwise bears a gradient
};

inline Eigen::Matrix3d intrinsics(double f_px, double width_px, double height_px) {
    Eigen::Matrix3d K;
    K << f_px, 0, 0.5 * (width_px - 1), 0, f_px, 0.5 * (height_px - 1), 0, 0, 1;
    return K;
}

/// A wall at z = 4 m and, before it at z = 2 m, a red square of 1 m; seen from (x, 0, 0) along z.
inline DepthView wall_and_square(double x_m, int width_px, int height_px,
                                 const WallAndSquare& set = {}) {
    constexpr double wall_m = 4, square_m = 2;
    DepthView view;
    view.name = "at " + std::to_string(x_m);
    view.K = intrinsics(0.8 * width_px, width_px, height_px);
    view.world_from_camera.translation().x() = x_m;
    view.colour.create(height_px, width_px);
    view.depth_m.create(height_px, width_px);
    for (int v = 0; v < height_px; ++v)
        for (int u = 0; u < width_px; ++u) {
            const double dx = (u - view.K(0, 2)) / view.K(0, 0);
            const double dy = (v - view.K(1, 2)) / view.K(1, 1);
            const bool is_square = std::abs(x_m + square_m * dx - set.square_x_m) < 0.5 &&
                                   std::abs(square_m * dy) < 0.5;
            const double wall_x = x_m + wall_m * dx, wall_y = wall_m * dy;
            const double across = set.waves ? 100 * std::sin(4 * wall_x) : 30 * wall_x;
            const double down = set.waves ? 50 * wall_y : 30 * wall_y;
            view.depth_m(v, u) = static_cast<float>(is_square ? square_m : wall_m);
            view.colour(v, u) = is_square ? cv::Vec4b(220, 30, 30, 255)
                                          : cv::Vec4b(20, cv::saturate_cast<uchar>(128 + across),
                                                      cv::saturate_cast<uchar>(128 + down), 255);
        }
    return view;
}

}  // namespace vantage
