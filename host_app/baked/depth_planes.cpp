#include "host_app/baked/depth_planes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// The window in which a plane is fitted to a pixel's surroundings: pixels to either side.
constexpr int fit_reach = 2;
/// Relative difference of inverse depth, beside the fitted slope, up to which a pixel counts as the
/// same plane. Twice the quantisation of refined depth.
constexpr float plane_tolerance = 0.004f;
/// Limits of the edge filter, as TriangleBuilder has them: the slope of a surface against the line
/// of sight, the least share of the depth, and the step in tolerances that is always an edge.
constexpr double max_slope = 8.0, min_step = 0.0075;
constexpr float always_edge = 3;
/// Reach of lens and sensor beside a depth edge, px, and the least confidence
/// (edge_confidence.frag).
constexpr int edge_reach_px = 2;
constexpr float min_edge_confidence = 0.02f;

bool is_edge(float a, float b) { return std::max(a, b) > std::min(a, b) * depth_edge_ratio; }

/// The confidence of a pixel, with the depth of the pixels around it from `depth_at(dx, dy)`.
template <class DepthAt>
float edge_confidence_by(const DepthAt& depth_at) {
    const float own = depth_at(0, 0);
    float nearest = (edge_reach_px + 1) * (edge_reach_px + 1);
    for (int y = -edge_reach_px; y <= edge_reach_px; ++y)
        for (int x = -edge_reach_px; x <= edge_reach_px; ++x)
            if (is_edge(depth_at(x, y), own))
                nearest = std::min(nearest, static_cast<float>(x * x + y * y));
    const float pure = (std::sqrt(nearest) - 1) / edge_reach_px;
    return min_edge_confidence + (1 - min_edge_confidence) * pure * pure;
}

}  // namespace

DepthPlanes::DepthPlanes(const DepthView& view)
    : K_(scaled_intrinsics(view.K, static_cast<double>(view.depth_m.cols) / view.colour.cols,
                           static_cast<double>(view.depth_m.rows) / view.colour.rows)),
      K_inverse_(K_.inverse()),
      kinds_(view.depth_m.size()),
      joints_(view.depth_m.size()),
      inverse_m_(view.depth_m.size()),
      slopes_(view.depth_m.size()) {
    cv::Mat1f raw(view.depth_m.size());
    for (int y = 0; y < raw.rows; ++y)
        for (int x = 0; x < raw.cols; ++x) {
            const float z = view.depth_m(y, x);
            kinds_(y, x) = z > 0 ? measured : z < 0 ? inpainted : unknown;
            raw(y, x) = z != 0 ? 1 / std::abs(z) : 0.0f;
        }
    fit(raw);
    join();
}

void DepthPlanes::drop(int x, int y) {
    kinds_(y, x) = unknown;
    inverse_m_(y, x) = 0;
    joints_(y, x) = 0;
    if (x > 0) joints_(y, x - 1) &= ~1;
    if (y > 0) joints_(y - 1, x) &= ~2;
}

void DepthPlanes::fit(const cv::Mat1f& raw) {
    const cv::Rect all({0, 0}, raw.size());
    for (int y = 0; y < raw.rows; ++y)
        for (int x = 0; x < raw.cols; ++x) {
            const float own = raw(y, x);
            inverse_m_(y, x) = own;
            slopes_(y, x) = {0, 0};
            if (own == 0) continue;
            // The slope to the neighbour that continues best, on either axis, as a first guess.
            const auto first_slope = [&](int dx, int dy) {
                float best = 0;
                bool has_one = false;
                for (const int side : {-1, 1}) {
                    const cv::Point at(x + side * dx, y + side * dy);
                    if (!all.contains(at) || raw(at) == 0) continue;
                    const float slope = static_cast<float>(side) * (raw(at) - own);
                    if (!has_one || std::abs(slope) < std::abs(best)) best = slope;
                    has_one = true;
                }
                return best;
            };
            const float guess_x = first_slope(1, 0), guess_y = first_slope(0, 1);
            // Least squares of w = a + b * dx + c * dy over the pixels of the same plane.
            Eigen::Matrix3f normal = Eigen::Matrix3f::Zero();
            Eigen::Vector3f right = Eigen::Vector3f::Zero();
            int count = 0;
            for (int dy = -fit_reach; dy <= fit_reach; ++dy)
                for (int dx = -fit_reach; dx <= fit_reach; ++dx) {
                    const cv::Point at(x + dx, y + dy);
                    if (!all.contains(at) || raw(at) == 0) continue;
                    const float expected =
                        own + static_cast<float>(dx) * guess_x + static_cast<float>(dy) * guess_y;
                    const float reach = static_cast<float>(std::max(std::abs(dx), std::abs(dy)));
                    if (std::abs(raw(at) - expected) > plane_tolerance * own * (1 + reach))
                        continue;
                    const Eigen::Vector3f row(1, static_cast<float>(dx), static_cast<float>(dy));
                    normal += row * row.transpose();
                    right += row * raw(at);
                    ++count;
                }
            slopes_(y, x) = {guess_x, guess_y};
            constexpr int least_to_fit = 9;
            if (count < least_to_fit || std::abs(normal.determinant()) < 1) continue;
            const Eigen::Vector3f plane = normal.inverse() * right;
            if (std::abs(plane[0] - own) > plane_tolerance * own) continue;
            inverse_m_(y, x) = plane[0];
            slopes_(y, x) = {plane[1], plane[2]};
        }
}

void DepthPlanes::join() {
    const auto tolerance = static_cast<float>(std::max(max_slope / K_(0, 0), min_step));
    const auto at = [&](int x, int y) {
        return inverse_m_(std::clamp(y, 0, inverse_m_.rows - 1),
                          std::clamp(x, 0, inverse_m_.cols - 1));
    };
    const auto joined = [&](float before, float a, float b, float after) {
        if (a <= 0 || b <= 0) return false;
        const float scale = tolerance * std::max(a, b), jump = b - a;
        float bend = std::abs(jump);
        if (before > 0) bend = std::min(bend, std::abs(jump - (a - before)));
        if (after > 0) bend = std::min(bend, std::abs(jump - (after - b)));
        return bend <= scale && std::abs(jump) <= always_edge * scale;
    };
    for (int y = 0; y < joints_.rows; ++y)
        for (int x = 0; x < joints_.cols; ++x) {
            const bool right =
                x + 1 < joints_.cols && joined(at(x - 1, y), at(x, y), at(x + 1, y), at(x + 2, y));
            const bool down =
                y + 1 < joints_.rows && joined(at(x, y - 1), at(x, y), at(x, y + 1), at(x, y + 2));
            joints_(y, x) = static_cast<uchar>((right ? 1 : 0) | (down ? 2 : 0));
        }
}

double DepthPlanes::pixels_per_square_m(int x, int y) const {
    const double w = inverse_m_(y, x);
    if (w <= 0) return 0;
    // The plane n * P = 1 has the inverse depth n * K^-1 (u, v, 1).
    const double a = slopes_(y, x)[0], b = slopes_(y, x)[1];
    const Eigen::Vector3d n = K_.transpose() * Eigen::Vector3d(a, b, w - a * x - b * y);
    const Eigen::Vector3d ray = K_inverse_ * Eigen::Vector3d(x, y, 1);
    const double cosine = w / (n.norm() * ray.norm());
    return K_(0, 0) * K_(1, 1) * w * w * cosine;
}

float DepthPlanes::edge_confidence(int x, int y) const {
    return edge_confidence_by([&](int dx, int dy) {
        const float w = inverse_m_(std::clamp(y + dy, 0, inverse_m_.rows - 1),
                                   std::clamp(x + dx, 0, inverse_m_.cols - 1));
        return w > 0 ? 1 / w : 0.0f;
    });
}

cv::Mat1b edge_confidence_of(const DepthImage& depth_m, cv::Size picture) {
    cv::Mat1b confidence(picture);
    const auto depth_at = [&](int x, int y) {
        const auto along = [](int at, int picture_px, int depth_px) {
            return std::clamp(static_cast<int>((at + 0.5) * depth_px / picture_px), 0,
                              depth_px - 1);
        };
        return std::abs(
            depth_m(along(y, picture.height, depth_m.rows), along(x, picture.width, depth_m.cols)));
    };
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            confidence(y, x) = cv::saturate_cast<uchar>(
                255 * edge_confidence_by([&](int dx, int dy) { return depth_at(x + dx, y + dy); }));
    return confidence;
}

}  // namespace vantage
