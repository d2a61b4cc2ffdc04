#include "host_app/desk/feed/surface_pick.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_app/desk/feed/rig_points.h"

namespace vantage {
namespace {

/// Of a rig's depth, evenly over its picture.
constexpr int most_points_of_a_rig = 30'000;
/// Around the place, of the picture's width; and how far surfaces that are one may differ in depth.
constexpr double radius_widths = 0.015, same_surface = 0.04;
constexpr std::size_t least_points = 6;

/// What is taken for one performer: this far around the vertical through the middle, above the
/// floor, below a raised hand.
constexpr double performer_radius_m = 0.45, above_floor_m = 0.2, highest_m = 2.4;
constexpr std::size_t least_performer_points = 40;
constexpr int shifts = 4;

}  // namespace

std::optional<Eigen::Vector3d> surface_at(const FrameSet& set, const CameraState& camera,
                                          double aspect, const Eigen::Vector2d& place) {
    const Pose camera_from_world = camera.world_from_camera.inverse();
    const double width = 2 * std::tan(0.5 * camera.field_of_view_rad);
    const Eigen::Vector2d at(width * (place.x() - 0.5), width * aspect * (place.y() - 0.5));
    struct Seen {
        double depth_m;
        Eigen::Vector3d point_m;
    };
    std::vector<Seen> seen;
    for_each_rig_point(set, most_points_of_a_rig,
                       [&](const Eigen::Vector3d& point_m, const cv::Vec4b&) {
                           const Eigen::Vector3d there = camera_from_world * point_m;
                           if (there.z() <= 0) return;
                           if ((there.head<2>() / there.z() - at).norm() < radius_widths * width)
                               seen.push_back({there.z(), point_m});
                       });
    std::sort(seen.begin(), seen.end(),
              [](const Seen& a, const Seen& b) { return a.depth_m < b.depth_m; });
    // A tenth of what is there is a surface, and not the mistakes before it.
    const std::size_t enough = std::max(least_points, seen.size() / 10);
    for (std::size_t first = 0; first + enough <= seen.size(); ++first) {
        if (seen[first + enough - 1].depth_m > (1 + same_surface) * seen[first].depth_m) continue;
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        double count = 0;
        for (std::size_t i = first;
             i < seen.size() && seen[i].depth_m <= (1 + same_surface) * seen[first].depth_m; ++i) {
            sum += seen[i].point_m;
            ++count;
        }
        return sum / count;
    }
    return std::nullopt;
}

std::optional<Eigen::Vector3d> foreground_near(const FrameSet& set,
                                               const Eigen::Vector3d& pivot_m) {
    std::vector<Eigen::Vector2d> around;
    const Eigen::Vector2d start(pivot_m.x(), pivot_m.z());
    for_each_rig_point(set, most_points_of_a_rig,
                       [&](const Eigen::Vector3d& point_m, const cv::Vec4b&) {
                           const Eigen::Vector2d ground(point_m.x(), point_m.z());
                           if (point_m.y() > above_floor_m && point_m.y() < highest_m &&
                               (ground - start).norm() < 2 * performer_radius_m)
                               around.push_back(ground);
                       });
    Eigen::Vector2d middle = start;
    for (int i = 0; i < shifts; ++i) {
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        std::size_t count = 0;
        for (const Eigen::Vector2d& ground : around) {
            if ((ground - middle).norm() >= performer_radius_m) continue;
            sum += ground;
            ++count;
        }
        if (count < least_performer_points) return std::nullopt;
        middle = sum / static_cast<double>(count);
    }
    return Eigen::Vector3d(middle.x(), pivot_m.y(), middle.y());
}

}  // namespace vantage
