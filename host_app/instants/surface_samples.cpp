#include "host_app/instants/surface_samples.h"

#include <algorithm>

#include <Eigen/LU>

#include "host_app/instants/projection.h"

namespace vantage {
namespace {

constexpr int samples_a_side = 12;

}  // namespace

SurfaceSamples surface_samples(const DepthView& view) {
    SurfaceSamples samples;
    const DepthImage& depth_m = view.depth_m;
    if (depth_m.empty() || view.colour.empty()) return samples;
    const Eigen::Matrix3d ray_from_pixel =
        scaled_intrinsics(view.K, static_cast<double>(depth_m.cols) / view.colour.cols,
                          static_cast<double>(depth_m.rows) / view.colour.rows)
            .inverse();
    std::vector<double> depths_m;
    for (int j = 0; j < samples_a_side; ++j)
        for (int i = 0; i < samples_a_side; ++i) {
            const int x = (2 * i + 1) * depth_m.cols / (2 * samples_a_side);
            const int y = (2 * j + 1) * depth_m.rows / (2 * samples_a_side);
            const double z = depth_m(y, x);
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
