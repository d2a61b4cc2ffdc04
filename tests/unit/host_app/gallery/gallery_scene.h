#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/LU>

#include "host_app/views/depth_view.h"

namespace vantage {

/// A red ball of radius 0.5 m in the origin, 1 m above a floor (y down), before a wavy wall at
/// z = 2 m; ray-traced, with exact depth.
struct BallScene {
    static constexpr double radius_m = 0.5, wall_m = 2, floor_m = 1;
    bool has_ball = true;
    double ball_y_m = 0;  ///< of its middle

    /// From a camera anywhere, along z of its own.
    DepthView seen_from(const Pose& world_from_camera, const Eigen::Matrix3d& K,
                        cv::Size size) const {
        DepthView view;
        view.K = K;
        view.world_from_camera = world_from_camera;
        view.colour.create(size);
        view.depth_m.create(size);
        const Eigen::Matrix3d ray_from_pixel = K.inverse();
        const Eigen::Vector3d o = world_from_camera.translation();
        const Eigen::Vector3d from_ball = o - Eigen::Vector3d(0, ball_y_m, 0);
        for (int v = 0; v < size.height; ++v)
            for (int u = 0; u < size.width; ++u) {
                const Eigen::Vector3d d =
                    world_from_camera.linear() * (ray_from_pixel * Eigen::Vector3d(u, v, 1));
                double z = 1e9;
                cv::Vec4b colour(0, 0, 0, 255);
                if (const double t = (wall_m - o.z()) / d.z(); t > 0) {
                    const Eigen::Vector3d at = o + t * d;
                    z = t;
                    colour = cv::Vec4b(20, wave(at.x()), wave(1.3 * at.y() + 1), 255);
                }
                if (const double t = (floor_m - o.y()) / d.y(); t > 0 && t < z) {
                    const Eigen::Vector3d at = o + t * d;
                    z = t;
                    colour = cv::Vec4b(40, wave(at.z() + 2), wave(at.x()), 255);
                }
                const double a = d.squaredNorm(), b = from_ball.dot(d),
                             c = from_ball.squaredNorm() - radius_m * radius_m;
                if (const double root = b * b - a * c; has_ball && root >= 0) {
                    const double t = (-b - std::sqrt(root)) / a;
                    if (t > 0 && t < z) {
                        z = t;
                        colour = cv::Vec4b(220, 30, 30, 255);
                    }
                }
                view.colour(v, u) = colour;
                view.depth_m(v, u) = static_cast<float>(z);
            }
        return view;
    }

  private:
    static uchar wave(double at_m) {
        return static_cast<uchar>(std::lround(110 + 60 * std::sin(3 * at_m)));
    }
};

/// From 3 m away, `angle_deg` around the ball, looking at it.
inline DepthView ball_and_wall(double angle_deg, cv::Size size, bool has_ball) {
    const double angle = angle_deg * std::numbers::pi / 180;
    const Eigen::Vector3d from(3 * std::sin(angle), -0.2, -3 * std::cos(angle));
    Eigen::Matrix3d K;
    K << 0.9 * size.width, 0, 0.5 * (size.width - 1), 0, 0.9 * size.width, 0.5 * (size.height - 1),
        0, 0, 1;
    DepthView view = BallScene{has_ball}.seen_from(look_at(from, {0, 0, 0}, {0, -1, 0}), K, size);
    view.name = std::to_string(angle_deg);
    return view;
}

inline VirtualView view_of_scene(const DepthView& view) {
    return {view.colour.cols, view.colour.rows, view.K, view.world_from_camera};
}

/// What is red in a picture, of what is covered.
struct Outline {
    double area = 0;  ///< px
    cv::Point2d middle;
};
inline Outline red_outline(const ColourImage& picture) {
    Outline outline;
    for (int v = 0; v < picture.rows; ++v)
        for (int u = 0; u < picture.cols; ++u) {
            const cv::Vec4b& c = picture(v, u);
            if (c[0] <= 120 || c[1] >= 110 || c[3] < 128) continue;
            outline.area += 1;
            outline.middle += cv::Point2d(u, v);
        }
    outline.middle *= 1 / std::max(outline.area, 1.0);
    return outline;
}

}  // namespace vantage
