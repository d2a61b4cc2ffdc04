#include "host_app/views/surface_samples.h"

#include <algorithm>

#include <Eigen/LU>

#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Rows and columns of the sampling grid: enough for ranking views, and cheap for every frame.
constexpr int samples_per_side = 12;

}  // namespace

SurfaceSamples surface_samples(const DepthView& view) {
    SurfaceSamples samples;
    if (!view.has_depth() || view.colour.empty()) return samples;
    const cv::Size size = view.depth_size();
    const Eigen::Matrix3d ray_from_pixel =
        scaled_intrinsics(view.K, static_cast<double>(size.width) / view.colour.cols,
                          static_cast<double>(size.height) / view.colour.rows)
            .inverse();
    std::vector<double> depths_m;
    for (int j = 0; j < samples_per_side; ++j)
        for (int i = 0; i < samples_per_side; ++i) {
            const int x = (2 * i + 1) * size.width / (2 * samples_per_side);
            const int y = (2 * j + 1) * size.height / (2 * samples_per_side);
            const double z = view.depth_m_at(x, y);
            if (!(z > 0)) continue;
            depths_m.push_back(z);
            const Eigen::Vector3d point = z * (ray_from_pixel * Eigen::Vector3d(x, y, 1));
            samples.points_m.push_back(view.world_from_camera * point);
        }
    if (depths_m.empty()) return samples;
    const auto middle = depths_m.begin() + static_cast<std::ptrdiff_t>(depths_m.size() / 2);
    std::nth_element(depths_m.begin(), middle, depths_m.end());
    samples.median_depth_m = *middle;
    return samples;
}

}  // namespace vantage
