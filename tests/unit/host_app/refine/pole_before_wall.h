#pragma once

#include <cmath>

#include "host_app/background/background_stereo.h"

namespace vantage {

inline const cv::Size matched_size{160, 120};
inline constexpr float wall_behind_m = 4, near_pole_m = 2;
/// The pole in the picture of the rig at x = 0.
inline const cv::Rect pole_place(80, 20, 3, 80);

/// The background of a rig at x before a checkered wall and a pole, which its own depth misses.
inline BackgroundView background_with_pole(double x_m, const cv::Rect& pole = pole_place) {
    BackgroundView view;
    view.K << 150, 0, 80, 0, 150, 60, 0, 0, 1;
    view.world_from_camera.translation().x() = x_m;
    view.baseline_m = 0.15;
    view.colour = ColourImage(matched_size);
    view.depth_m = DepthImage(matched_size, wall_behind_m);
    for (int y = 0; y < matched_size.height; ++y)
        for (int x = 0; x < matched_size.width; ++x) {
            const bool is_light =
                (std::lround(x + 150 * x_m / wall_behind_m + 400) / 5 + y / 5) % 2 == 0;
            view.colour(y, x) = is_light ? cv::Vec4b(60, 140, 60, 255) : cv::Vec4b(20, 60, 20, 255);
        }
    const cv::Rect seen(pole.x - static_cast<int>(std::lround(150 * x_m / near_pole_m)), pole.y,
                        pole.width, pole.height);
    view.colour(seen & cv::Rect({0, 0}, matched_size)) = cv::Vec4b(220, 160, 230, 255);
    return view;
}

}  // namespace vantage
