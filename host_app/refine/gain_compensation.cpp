#include "host_app/refine/gain_compensation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Grid of surface points that are sampled at one instant.
constexpr int grid_columns = 40, grid_rows = 30;
/// Ratio of depths in a neighbourhood from which on it is an edge and no sample.
constexpr float smooth_ratio = 1.02f;
/// Relative difference of depths up to which two rigs see the same surface. Smaller than
/// surface_share, since a wrong pair does more harm than a missing one.
constexpr double same_surface = 0.015;
/// 8-bit values below are noise, above clipped.
constexpr int darkest = 10, brightest = 245;
/// Cosine of the largest angle between two lines of sight: gloss changes with the angle.
const double min_cosine = std::cos(0.9);
/// Median deviation of the logarithms of ratios from which on a pair does not see one surface.
constexpr double max_spread = 0.3;
/// Deviation of a ratio's logarithm from the typical one up to which it is an inlier.
constexpr double inlier = 0.08;
/// Weight of a rig's present gain, in samples, so that a rig without samples has a solution: 0.
constexpr double inertia = 1;

const std::array<double, 256>& decoded() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> values{};
        for (std::size_t v = 0; v < values.size(); ++v)
            values[v] = srgb_decode(static_cast<double>(v) / 255);
        return values;
    }();
    return table;
}

/// A view that surface points can be looked up in.
class Lookup {
  public:
    explicit Lookup(const DepthView& view)
        : view_(&view),
          scale_x_(static_cast<double>(view.depth_size().width) / view.colour.cols),
          scale_y_(static_cast<double>(view.depth_size().height) / view.colour.rows),
          K_(scaled_intrinsics(view.K, scale_x_, scale_y_)),
          ray_from_pixel_(K_.inverse()),
          camera_from_world_(view.world_from_camera.inverse()) {}

    Eigen::Vector3d centre() const { return view_->world_from_camera.translation(); }
    cv::Size size() const { return view_->depth_size(); }

    struct Sample {
        Eigen::Vector3d point;   ///< in the world
        Eigen::Vector3d colour;  ///< linear, after the calibration's correction
    };
    /// The sample at a pixel of the depth map; nothing at an edge, where depth is unknown, or where
    /// the colour is too dark or clipped.
    std::optional<Sample> at(int x, int y) const {
        if (x < 1 || y < 1 || x >= size().width - 1 || y >= size().height - 1) return std::nullopt;
        const float here_m = view_->depth_m_at(x, y);
        float nearest = here_m, farthest = nearest;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const float z_m = view_->depth_m_at(x + dx, y + dy);
                nearest = std::min(nearest, z_m);
                farthest = std::max(farthest, z_m);
            }
        if (!(nearest > 0) || farthest > smooth_ratio * nearest) return std::nullopt;
        const std::optional<Eigen::Vector3d> colour = colour_at(x, y);
        if (!colour) return std::nullopt;
        const Eigen::Vector3d point = here_m * (ray_from_pixel_ * Eigen::Vector3d(x, y, 1));
        return Sample{view_->world_from_camera * point, *colour};
    }

    /// The sample of the same surface point in this view; nothing if the view does not show it.
    std::optional<Sample> at(const Eigen::Vector3d& world) const {
        const Eigen::Vector3d point = camera_from_world_ * world;
        if (point.z() <= 0) return std::nullopt;
        const Eigen::Vector3d pixel = K_ * point / point.z();
        if (!(pixel.x() >= 0 && pixel.x() < size().width && pixel.y() >= 0 &&
              pixel.y() < size().height))
            return std::nullopt;
        const int x = cvRound(pixel.x()), y = cvRound(pixel.y());
        std::optional<Sample> here = at(x, y);
        if (!here || std::abs(view_->depth_m_at(x, y) / point.z() - 1) > same_surface)
            return std::nullopt;
        return here;
    }

  private:
    /// The mean of 3x3 pixels, so that noise and fine texture do not count.
    std::optional<Eigen::Vector3d> colour_at(int x, int y) const {
        const ColourImage& picture = view_->colour;
        const int u = static_cast<int>((x + 0.5) / scale_x_),
                  v = static_cast<int>((y + 0.5) / scale_y_);
        if (u < 1 || v < 1 || u >= picture.cols - 1 || v >= picture.rows - 1) return std::nullopt;
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const cv::Vec4b& code = picture(v + dy, u + dx);
                for (int c = 0; c < 3; ++c) {
                    if (code[c] < darkest || code[c] > brightest) return std::nullopt;
                    sum[c] += decoded()[code[c]];
                }
            }
        const ColourCorrection& correction = view_->colour_correction;
        Eigen::Vector3d linear = sum / 9;
        for (int c = 0; c < 3; ++c) linear[c] = std::pow(linear[c], correction.tone[c]);
        linear = correction.matrix * linear;
        if (!(linear.minCoeff() > 1e-4)) return std::nullopt;
        return linear;
    }

    const DepthView* view_;
    double scale_x_, scale_y_;
    Eigen::Matrix3d K_, ray_from_pixel_;
    Pose camera_from_world_;
};

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Logarithms of the ratios between two rigs' colours of the same surface points.
class Ratios {
  public:
    void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        for (std::size_t c = 0; c < 3; ++c) {
            const auto i = static_cast<Eigen::Index>(c);
            logs_[c].push_back(std::log(a[i] / b[i]));
        }
    }
    int count() const { return static_cast<int>(logs_[0].size()); }
    /// The robust mean of a channel; nothing if there are too few samples or they spread too far.
    std::optional<double> typical(int channel) {
        std::vector<double>& values = logs_[static_cast<std::size_t>(channel)];
        if (count() < GainCompensation::min_samples) return std::nullopt;
        const double middle = median(values);
        std::vector<double> off = values;
        for (double& value : off) value = std::abs(value - middle);
        if (median(off) > max_spread) return std::nullopt;
        // Outliers lie mostly on one side and move the median there.
        double centre = middle;
        for (int round = 0; round < 4; ++round) {
            std::vector<double> near;
            std::copy_if(values.begin(), values.end(), std::back_inserter(near),
                         [&](double value) { return std::abs(value - centre) < inlier; });
            if (near.empty()) break;
            centre = median(near);
        }
        return centre;
    }

  private:
    std::array<std::vector<double>, 3> logs_;
};

/// A view with samples of its surface: one for each cell of a grid, at a place that `shift`
/// selects.
struct SampledView {
    Lookup view;
    std::vector<Lookup::Sample> samples;

    SampledView(const DepthView& seen, int shift) : view(seen) {
        const cv::Size size = view.size();
        for (int row = 0; row < grid_rows; ++row)
            for (int column = 0; column < grid_columns; ++column)
                if (const auto sample =
                        view.at((column * 8 + shift % 8) * size.width / (grid_columns * 8),
                                (row * 8 + shift / 8 % 8) * size.height / (grid_rows * 8)))
                    samples.push_back(*sample);
    }
};

/// Adds the ratios of one view's surface points to another view's colours of them.
void compare(const SampledView& from, const Lookup& to, bool swapped, Ratios& ratios) {
    for (const Lookup::Sample& a : from.samples) {
        const Eigen::Vector3d ray = (a.point - from.view.centre()).normalized();
        if (ray.dot((a.point - to.centre()).normalized()) < min_cosine) continue;
        const auto b = to.at(a.point);
        if (!b) continue;
        if (swapped)
            ratios.add(b->colour, a.colour);
        else
            ratios.add(a.colour, b->colour);
    }
}

}  // namespace

void GainCompensation::see(std::span<const DepthView> views, double dt_s) {
    since_sample_s_ += std::max(dt_s, 0.0);
    if (since_sample_s_ < sample_period_s) return;
    // After a long pause the light may have changed; the gains must not jump even then.
    const double passed_s = std::min(since_sample_s_, 5 * sample_period_s);
    since_sample_s_ = 0;
    const int shift = 11 * samplings_++;

    std::vector<SampledView> sampled;
    std::vector<Rig*> rigs;
    for (const DepthView& view : views) {
        if (!view.has_depth() || view.colour.empty()) continue;
        sampled.emplace_back(view, shift);
        rigs.push_back(&rigs_[view.name]);
        rigs.back()->samples = 0;
    }
    // Least squares over all pairs for the changes of the gains that make all ratios 1. Both rigs
    // of a pair enter with opposite signs, so that the changes of connected rigs add up to 0.
    const auto count = static_cast<Eigen::Index>(rigs.size());
    std::array<Eigen::MatrixXd, 3> normal;
    normal.fill(inertia * Eigen::MatrixXd::Identity(count, count));
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, 3);
    for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index j = i + 1; j < count; ++j) {
            const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
            Ratios ratios;
            compare(sampled[a], sampled[b].view, false, ratios);
            compare(sampled[b], sampled[a].view, true, ratios);
            rigs[a]->samples += ratios.count();
            rigs[b]->samples += ratios.count();
            const double weight = ratios.count();
            for (int c = 0; c < 3; ++c) {
                const std::optional<double> measured = ratios.typical(c);
                if (!measured) continue;
                const double remaining = *measured + rigs[a]->log_gain[c] - rigs[b]->log_gain[c];
                Eigen::MatrixXd& n = normal[static_cast<std::size_t>(c)];
                n(i, i) += weight;
                n(j, j) += weight;
                n(i, j) -= weight;
                n(j, i) -= weight;
                right(i, c) -= weight * remaining;
                right(j, c) += weight * remaining;
            }
        }
    if (count == 0) return;
    const double part = 1 - std::exp(-passed_s / time_constant_s);
    for (int c = 0; c < 3; ++c) {
        Eigen::VectorXd step =
            part * normal[static_cast<std::size_t>(c)].ldlt().solve(right.col(c));
        // One factor for all rigs, so that the mean stays.
        const double fastest = step.cwiseAbs().maxCoeff(), limit = slew_per_s * passed_s;
        if (fastest > limit) step *= limit / fastest;
        for (Eigen::Index i = 0; i < count; ++i) {
            double& gain = rigs[static_cast<std::size_t>(i)]->log_gain[c];
            gain = std::clamp(gain + step[i], -std::log(max_gain), std::log(max_gain));
        }
    }
}

void GainCompensation::apply(DepthView& view) const {
    const auto rig = rigs_.find(view.name);
    if (rig == rigs_.end() || rig->second.log_gain.cwiseAbs().maxCoeff() <= negligible) return;
    Eigen::Matrix3d& matrix = view.colour_correction.matrix;
    matrix = rig->second.gain().asDiagonal() * Eigen::Matrix3d(matrix);
}

}  // namespace vantage
