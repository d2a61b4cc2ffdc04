#include "calib_tools/colour/overlap.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

namespace vantage {
namespace {

constexpr double edge_share = 0.02, hidden_share = 0.15, same_share = 0.02;
constexpr int most_texture = 24;  ///< in grey levels within 3 x 3 pixels

struct Place {
    double depth_m = 0;
    Eigen::Vector3d coded;
};

/// Mean of 3 x 3 pixels if they belong to one smooth, evenly coloured surface; else empty.
std::optional<Place> place_at(const OverlapView& view, int x, int y) {
    if (x < 1 || y < 1 || x >= view.colour.cols - 1 || y >= view.colour.rows - 1)
        return std::nullopt;
    float near = view.depth_m(y, x), far = near;
    int low[3] = {255, 255, 255}, high[3] = {0, 0, 0};
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const float z = view.depth_m(y + dy, x + dx);
            if (!(z > 0)) return std::nullopt;
            near = std::min(near, z);
            far = std::max(far, z);
            const cv::Vec4b& c = view.colour(y + dy, x + dx);
            for (int k = 0; k < 3; ++k) {
                low[k] = std::min<int>(low[k], c[k]);
                high[k] = std::max<int>(high[k], c[k]);
                sum[k] += c[k];
            }
        }
    if (far - near > edge_share * near) return std::nullopt;
    for (int k = 0; k < 3; ++k)
        if (high[k] - low[k] > most_texture) return std::nullopt;
    return Place{view.depth_m(y, x), sum / (9 * 255.0)};
}

void sample_pair(const std::vector<OverlapView>& views, int a, int b, int most,
                 std::vector<OverlapSample>& samples) {
    const OverlapView& from = views[static_cast<std::size_t>(a)];
    const OverlapView& to = views[static_cast<std::size_t>(b)];
    const Eigen::Matrix3d ray_from_pixel = from.K.inverse();
    const Pose b_from_a = to.world_from_camera.inverse() * from.world_from_camera;
    const int step = std::max(
        1,
        static_cast<int>(std::floor(std::sqrt(static_cast<double>(from.colour.total()) / most))));
    for (int y = step / 2; y < from.colour.rows; y += step)
        for (int x = step / 2; x < from.colour.cols; x += step) {
            const std::optional<Place> place = place_at(from, x, y);
            if (!place) continue;
            const Eigen::Vector3d p =
                b_from_a * (place->depth_m * (ray_from_pixel * Eigen::Vector3d(x, y, 1)));
            if (!(p.z() > 0)) continue;
            const Eigen::Vector3d pixel = to.K * p / p.z();
            const std::optional<Place> other =
                place_at(to, static_cast<int>(std::lround(pixel.x())),
                         static_cast<int>(std::lround(pixel.y())));
            if (!other || other->depth_m < (1 - hidden_share) * p.z()) continue;
            OverlapSample sample;
            sample.a = a;
            sample.b = b;
            sample.a_px = {x, y};
            sample.b_px = pixel.head<2>();
            sample.predicted_m = p.z();
            sample.measured_m = other->depth_m;
            sample.disparity_miss =
                to.K(0, 0) * to.baseline_m * (1 / sample.predicted_m - 1 / sample.measured_m);
            sample.colours = {a, b, place->coded, other->coded};
            samples.push_back(sample);
        }
}

}  // namespace

std::vector<OverlapSample> overlap_samples(const std::vector<OverlapView>& views, int most) {
    std::vector<OverlapSample> samples;
    const int count = static_cast<int>(views.size());
    for (int a = 0; a < count; ++a)
        for (int b = 0; b < count; ++b)
            if (a != b) sample_pair(views, a, b, most, samples);
    return samples;
}

std::vector<ColourPair> same_surface(const std::vector<OverlapSample>& samples) {
    std::vector<ColourPair> pairs;
    for (const OverlapSample& s : samples)
        if (std::abs(s.predicted_m - s.measured_m) < same_share * s.predicted_m)
            pairs.push_back(s.colours);
    return pairs;
}

}  // namespace vantage
