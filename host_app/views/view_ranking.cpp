#include "host_app/views/view_ranking.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Added to angles, so that the usefulness of a camera in the same place stays finite.
constexpr double small_angle_rad = 0.02;

}  // namespace

double usefulness(std::span<const Eigen::Vector3d> sample_points_m,
                  const Eigen::Vector3d& source_centre_m, const VirtualView& target) {
    const Pose target_from_world = target.world_from_camera.inverse();
    const Eigen::Vector3d source_centre = target_from_world * source_centre_m;
    double sum = 0;
    for (const Eigen::Vector3d& point_world : sample_points_m) {
        const Eigen::Vector3d point = target_from_world * point_world;
        if (point.z() <= 0) continue;
        const Eigen::Vector3d pixel = target.K * point / point.z();
        // With a margin of a quarter of the picture, since surfaces extend beyond the few points.
        const double margin_x = 0.25 * target.width_px, margin_y = 0.25 * target.height_px;
        if (pixel.x() < -margin_x || pixel.x() > target.width_px + margin_x ||
            pixel.y() < -margin_y || pixel.y() > target.height_px + margin_y)
            continue;
        const double cosine = point.normalized().dot((point - source_centre).normalized());
        sum += 1 / (std::acos(std::clamp(cosine, -1.0, 1.0)) + small_angle_rad);
    }
    return sum;
}

}  // namespace vantage
