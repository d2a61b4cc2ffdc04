#include "common/board/corner_refiner.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>

namespace vantage {
namespace {

constexpr int parameter_count = 9;
using Parameters = Eigen::Matrix<double, parameter_count, 1>;
using NormalMatrix = Eigen::Matrix<double, parameter_count, parameter_count>;
// Parameters: x, y, edge angles 1 and 2, blur, mean, slope x, slope y, contrast.
enum { px, py, angle1, angle2, blur, mean, slope_x, slope_y, contrast };

struct Sample {
    double x, y, value, weight;
};

/// Values that all samples share for one set of parameters.
struct Edges {
    explicit Edges(const Parameters& p)
        : c1(std::cos(p[angle1])),
          s1(std::sin(p[angle1])),
          c2(std::cos(p[angle2])),
          s2(std::sin(p[angle2])),
          scale(1 / (std::numbers::sqrt2 * p[blur])) {}
    double c1, s1, c2, s2, scale;
};

/// Relative distance from an edge beyond which it adds less than a double holds.
constexpr double far_from_edge = 6;

/// The profile of a blurred edge, and without its constant factor the derivative of it.
double edge_at(double x) { return std::abs(x) > far_from_edge ? std::copysign(1, x) : std::erf(x); }
double slope_at(double x) { return std::abs(x) > far_from_edge ? 0 : std::exp(-x * x); }

double evaluate(const Parameters& p, const Edges& edges, const Sample& s, Parameters* gradient) {
    const double dx = s.x - p[px], dy = s.y - p[py];
    const auto [c1, s1, c2, s2, scale] = edges;
    // Signed distances from the edges, which have the directions (c, s).
    const double d1 = -s1 * dx + c1 * dy, d2 = -s2 * dx + c2 * dy;
    const double e1 = edge_at(d1 * scale), e2 = edge_at(d2 * scale);
    const double value = p[mean] + p[slope_x] * dx + p[slope_y] * dy + p[contrast] * e1 * e2;
    if (gradient) {
        const double peak = 2 * std::numbers::inv_sqrtpi;
        const double g1 = peak * slope_at(d1 * scale) * e2 * p[contrast];
        const double g2 = peak * slope_at(d2 * scale) * e1 * p[contrast];
        Parameters& g = *gradient;
        g[px] = scale * (g1 * s1 + g2 * s2) - p[slope_x];
        g[py] = -scale * (g1 * c1 + g2 * c2) - p[slope_y];
        g[angle1] = g1 * scale * (-c1 * dx - s1 * dy);
        g[angle2] = g2 * scale * (-c2 * dx - s2 * dy);
        g[blur] = -(g1 * d1 + g2 * d2) * scale / p[blur];
        g[mean] = 1;
        g[slope_x] = dx;
        g[slope_y] = dy;
        g[contrast] = e1 * e2;
    }
    return value;
}

double cost_of(const Parameters& p, const std::vector<Sample>& samples) {
    const Edges edges(p);
    double cost = 0;
    for (const Sample& s : samples) {
        const double r = evaluate(p, edges, s, nullptr) - s.value;
        cost += s.weight * r * r;
    }
    return cost;
}

}  // namespace

std::optional<CornerFit> fit_corner(const GreyImage& picture, const Eigen::Vector2d& start,
                                    const Eigen::Vector2d& along_row,
                                    const Eigen::Vector2d& along_column, double radius_px) {
    const int x0 = std::max(0, static_cast<int>(std::ceil(start.x() - radius_px)));
    const int x1 = std::min(picture.cols - 1, static_cast<int>(std::floor(start.x() + radius_px)));
    const int y0 = std::max(0, static_cast<int>(std::ceil(start.y() - radius_px)));
    const int y1 = std::min(picture.rows - 1, static_cast<int>(std::floor(start.y() + radius_px)));
    std::vector<Sample> samples;
    double low = 255, high = 0, sum = 0, sum_weight = 0;
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const double r = std::hypot(x - start.x(), y - start.y());
            if (r > radius_px) continue;
            // The weight fades out over the last pixel, so that the support does not jump with the
            // start point.
            const double weight = std::min(1.0, radius_px - r + 0.01);
            const double value = picture(y, x);
            samples.push_back({static_cast<double>(x), static_cast<double>(y), value, weight});
            low = std::min(low, value);
            high = std::max(high, value);
            sum += weight * value;
            sum_weight += weight;
        }
    if (samples.size() < 2 * parameter_count || high - low < 8) return std::nullopt;

    Parameters p;
    p[px] = start.x();
    p[py] = start.y();
    p[angle1] = std::atan2(along_row.y(), along_row.x());
    p[angle2] = std::atan2(along_column.y(), along_column.x());
    p[blur] = 0.8;
    p[mean] = sum / sum_weight;
    p[slope_x] = p[slope_y] = 0;
    p[contrast] = 0;
    // The sign tells which pair of opposite squares is black.
    double product = 0, norm = 0;
    p[contrast] = 1;
    const Edges start_edges(p);
    for (const Sample& s : samples) {
        const double shape = evaluate(p, start_edges, s, nullptr) - p[mean];
        product += s.weight * shape * (s.value - p[mean]);
        norm += s.weight * shape * shape;
    }
    if (!(norm > 0)) return std::nullopt;
    p[contrast] = product / norm;

    double cost = cost_of(p, samples), lambda = 1e-3;
    for (int iteration = 0; iteration < 30; ++iteration) {
        NormalMatrix normal = NormalMatrix::Zero();
        Parameters right = Parameters::Zero(), gradient;
        const Edges edges(p);
        for (const Sample& s : samples) {
            const double r = evaluate(p, edges, s, &gradient) - s.value;
            const Parameters weighted = s.weight * gradient;
            normal.noalias() += weighted * gradient.transpose();
            right -= r * weighted;
        }
        bool improved = false;
        double step_px = 0;
        for (int attempt = 0; attempt < 8 && !improved; ++attempt) {
            NormalMatrix damped = normal;
            damped.diagonal() *= 1 + lambda;
            damped.diagonal().array() += 1e-12;
            const Parameters step = damped.selfadjointView<Eigen::Lower>().ldlt().solve(right);
            Parameters next = p + step;
            next[blur] = std::clamp(next[blur], 0.2, 0.5 * radius_px);
            const double next_cost = step.allFinite() ? cost_of(next, samples) : cost;
            if (next_cost < cost) {
                step_px = step.head<2>().norm();
                p = next;
                cost = next_cost;
                lambda = std::max(1e-9, lambda * 0.2);
                improved = true;
            } else {
                lambda *= 8;
            }
        }
        if (!improved || step_px < 1e-4) break;
    }
    const Eigen::Vector2d found(p[px], p[py]);
    if (!p.allFinite() || (found - start).norm() > 0.5 * radius_px) return std::nullopt;
    return CornerFit{found, p[blur], std::abs(p[contrast]), std::sqrt(cost / sum_weight)};
}

}  // namespace vantage
