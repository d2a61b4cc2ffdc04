#include "host_app/background/background_stereo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include "host_app/background/still_image.h"
#include "host_app/views/projection.h"
#include "host_app/views/tolerances.h"

namespace vantage {
namespace {

/// Photometric cost in fixed point.
using Cost = std::int16_t;
constexpr Cost whole = 256;  ///< the largest cost of one comparison

/// Other rigs that a rig is compared with, at most: the nearest.
constexpr std::size_t max_others = 3;
/// Distance of another rig, in baselines of the rig, from which on it measures depth better than
/// the rig itself.
constexpr double min_apart = 2;

/// Mean difference of colours (0..255) that the largest cost stands for.
constexpr float max_difference = 25;
/// Costs of a depth that is hidden from the other rigs, and of one outside their pictures. A depth
/// that no other rig can check must not win for that reason.
constexpr Cost hidden_cost = 130, unseen_cost = 165;
/// Weight of the rig's own right image: right_share / shares; the other rigs have the rest.
constexpr int right_share = 5, shares = 8;
/// Added where another rig sees through the depth. A depth where another rig has its surface
/// (within surface_share) costs half.
constexpr int see_through_penalty = 77;
/// Penalty of a depth that is own_reach_px or more of the rig's own disparity away from its
/// matcher's.
constexpr float own_penalty = 50, own_reach_px = 2;
/// Smoothness penalties between neighbours: of a step to the next depth, and of a jump. The jump's
/// is halved at this difference of their colours (0..255).
constexpr Cost step_penalty = 10, jump_penalty = 256;
constexpr float halving_difference = 25;
/// Costs are averaged over 3x3 pixels; mean difference (0..255) at which a weight falls to 1/e.
constexpr float colour_falloff = 15;

/// Distance of two depths that are tried, px in the nearest other rig's picture.
constexpr double step_px = 1;
constexpr int min_depths = 16, max_depths = 256;
/// Range of inverse depths. At least these factors of the median, since matchers miss thin objects;
/// beyond that, the range of the rig's depths without these shares of its pixels, with a margin.
constexpr double farthest_tried = 0.4, nearest_tried = 2.2;
constexpr double farther_share = 0.01, nearer_share = 0.002, margin = 1.25;

/// Enlargement of the other pictures, whose nearest pixel is read instead of interpolating.
constexpr int fineness = 5;

/// The inverse depths that are tried, 1/m.
struct DepthRange {
    float farthest = 0, step = 0;
    int depths = 0;
    float at(float depth) const { return farthest + step * depth; }
};

/// Another rig, as the swept rig sees it.
struct Other {
    Eigen::Matrix4f from_pixel;
    cv::Mat4b fine;
    /// The least and the greatest inverse depth of each pixel and its neighbours to the right and
    /// below, 0 = unknown; empty in the first pass.
    cv::Mat2f inverse_depths;
};

Eigen::Matrix4d other_from_pixel(const BackgroundView& other, const BackgroundView& view) {
    DepthView target;
    target.K = other.K;
    target.world_from_camera = other.world_from_camera;
    return pixel_from_target_pixel(
        target, {view.colour.cols, view.colour.rows, view.K, view.world_from_camera});
}

double apart_m(const BackgroundView& a, const BackgroundView& b) {
    return (a.world_from_camera.translation() - b.world_from_camera.translation()).norm();
}

std::vector<std::size_t> others_of(std::span<const BackgroundView> views, std::size_t which) {
    const BackgroundView& view = views[which];
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < views.size(); ++i)
        if (i != which && apart_m(views[i], view) > min_apart * view.baseline_m)
            others.push_back(i);
    std::stable_sort(others.begin(), others.end(), [&](std::size_t a, std::size_t b) {
        return apart_m(views[a], view) < apart_m(views[b], view);
    });
    if (others.size() > max_others) others.resize(max_others);
    return others;
}

/// Without depths if no background is known.
DepthRange range_of(const BackgroundView& view, const BackgroundView& nearest) {
    std::vector<float> known;
    for (int y = 0; y < view.depth_m.rows; ++y)
        for (int x = 0; x < view.depth_m.cols; ++x)
            if (view.depth_m(y, x) > 0 && view.colour(y, x)[3] > 0)
                known.push_back(1 / view.depth_m(y, x));
    if (known.empty()) return {};
    std::sort(known.begin(), known.end());
    const auto share = [&](double of_all) {
        return known[static_cast<std::size_t>(of_all * static_cast<double>(known.size() - 1))];
    };
    const double median = share(0.5);
    const double farthest = std::min(share(farther_share) / margin, farthest_tried * median);
    const double closest = std::max(share(1 - nearer_share) * margin, nearest_tried * median);
    const double px_per_inverse_m =
        parallax_px(other_from_pixel(nearest, view),
                    {0.5 * view.colour.cols, 0.5 * view.colour.rows}, 1 / median) /
        median;
    const double depths = (closest - farthest) * px_per_inverse_m / step_px;
    DepthRange range;
    range.depths =
        std::isfinite(depths)
            ? static_cast<int>(std::clamp(std::ceil(depths), 1.0 * min_depths, 1.0 * max_depths))
            : max_depths;
    range.farthest = static_cast<float>(farthest);
    range.step = static_cast<float>((closest - farthest) / (range.depths - 1));
    return range;
}

cv::Mat2f inverse_depths_of(const DepthImage& depth_m) {
    cv::Mat2f bounds(depth_m.size());
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x) {
            float least = std::numeric_limits<float>::max(), most = 0;
            for (int k = 0; k < 4; ++k) {
                const float z = depth_m(std::min(y + k / 2, depth_m.rows - 1),
                                        std::min(x + k % 2, depth_m.cols - 1));
                if (z <= 0) continue;
                least = std::min(least, 1 / z);
                most = std::max(most, 1 / z);
            }
            bounds(y, x) = most > 0 ? cv::Vec2f(least, most) : cv::Vec2f(0, 0);
        }
    return bounds;
}

float difference(const cv::Vec4b& a, const cv::Vec4b& b) {
    return static_cast<float>(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) +
                              std::abs(a[2] - b[2])) /
           3;
}

/// Costs of all depths at all pixels; those of one pixel are contiguous.
class CostVolume {
  public:
    CostVolume(cv::Size size, int depths)
        : size_(size),
          depths_(depths),
          costs_(static_cast<std::size_t>(size.area()) * static_cast<std::size_t>(depths)) {}

    cv::Size size() const { return size_; }
    int depths() const { return depths_; }
    Cost* at(int y, int x) { return costs_.data() + offset(y, x); }
    const Cost* at(int y, int x) const { return costs_.data() + offset(y, x); }

  private:
    std::size_t offset(int y, int x) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(depths_);
    }
    cv::Size size_;
    int depths_;
    std::vector<Cost> costs_;
};

/// The cost for each sum of three channels' differences: a table saves a division and two roundings
/// for each of some hundred million readings.
constexpr std::array<Cost, 3 * 255 + 1> cost_of_difference = [] {
    std::array<Cost, 3 * 255 + 1> costs{};
    for (std::size_t sum = 0; sum < costs.size(); ++sum)
        costs[sum] = static_cast<Cost>(std::min(static_cast<float>(sum) / 3, max_difference) *
                                       (whole / max_difference));
    return costs;
}();

Cost cost_of(const cv::Vec4b& a, const cv::Vec4b& b) {
    return cost_of_difference[static_cast<std::size_t>(
        std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]))];
}

/// The places of one pixel's depths in another picture: points on the epipolar line.
class DepthLine {
  public:
    explicit DepthLine(const DepthRange& range)
        : inverse_m_(range.depths),
          z_(range.depths),
          u_(range.depths),
          v_(range.depths),
          seen_inverse_m_(range.depths),
          fine_(range.depths),
          pixel_(range.depths) {
        for (int k = 0; k < range.depths; ++k) inverse_m_[k] = range.at(static_cast<float>(k));
    }

    void project(const Other& other, cv::Point from_pixel) {
        const Eigen::Vector4f along =
            other.from_pixel * Eigen::Vector4f(static_cast<float>(from_pixel.x),
                                               static_cast<float>(from_pixel.y), 1, 0);
        const Eigen::Vector4f from = other.from_pixel.col(3);
        const int columns = other.fine.cols / fineness, rows = other.fine.rows / fineness;
        const auto right = static_cast<float>(columns - 1), bottom = static_cast<float>(rows - 1);
        // Being before the camera and within its picture are inequalities that are linear in the
        // inverse depth. Rounding errors at the ends are corrected below.
        first_ = 0;
        end_ = inverse_m_.size();
        keep(along.z(), from.z());
        keep(along.x(), from.x());
        keep(along.y(), from.y());
        keep(right * along.z() - along.x(), right * from.z() - from.x());
        keep(bottom * along.z() - along.y(), bottom * from.z() - from.y());
        if (first_ >= end_) return;
        place(along, from);
        const auto is_inside = [&](Eigen::Index k) {
            return z_[k] > 0 && u_[k] >= 0 && v_[k] >= 0 && u_[k] <= right && v_[k] <= bottom;
        };
        while (first_ < end_ && !is_inside(first_)) ++first_;
        while (first_ < end_ && !is_inside(end_ - 1)) --end_;
        const Eigen::Index count = end_ - first_;
        if (count <= 0) return;
        const auto u = u_.segment(first_, count).max(0.0f).min(right),
                   v = v_.segment(first_, count).max(0.0f).min(bottom);
        fine_.segment(first_, count) = (fineness * (v + 0.5f)).cast<int>() * other.fine.cols +
                                       (fineness * (u + 0.5f)).cast<int>();
        if (other.inverse_depths.empty()) return;
        pixel_.segment(first_, count) = v.cast<int>() * columns + u.cast<int>();
        seen_inverse_m_.segment(first_, count) =
            inverse_m_.segment(first_, count) / z_.segment(first_, count);
    }
    /// Calls read(depth, index in the enlarged picture) for the depths that lie in the picture.
    template <class Read>
    void for_each(const Read& read) const {
        for (Eigen::Index k = first_; k < end_; ++k)
            read(static_cast<std::size_t>(k), static_cast<std::size_t>(fine_[k]));
    }
    /// The pixel's index and the inverse depth as seen from there, for a depth that lies in the
    /// picture of a rig with inverse depths.
    std::size_t pixel(std::size_t depth) const {
        return static_cast<std::size_t>(pixel_[static_cast<Eigen::Index>(depth)]);
    }
    float seen_inverse_m(std::size_t depth) const {
        return seen_inverse_m_[static_cast<Eigen::Index>(depth)];
    }

  private:
    /// Computes z and the place in the picture for the depths from first_ to end_.
    void place(const Eigen::Vector4f& along, const Eigen::Vector4f& from) {
        const Eigen::Index count = end_ - first_;
        const auto inverse_m = inverse_m_.segment(first_, count);
        auto z = z_.segment(first_, count);
        z = along.z() + inverse_m * from.z();
        u_.segment(first_, count) = (along.x() + inverse_m * from.x()) / z;
        v_.segment(first_, count) = (along.y() + inverse_m * from.y()) / z;
    }
    /// Keeps the depths where at + inverse depth * slope >= 0, and one beyond.
    void keep(float at, float slope) {
        const float farthest = inverse_m_[0], step = inverse_m_[1] - farthest;
        constexpr float rounding = 1e-3f;
        const float at_first = at + farthest * slope + rounding, by_step = step * slope;
        const float zero = -at_first / by_step;
        if (!std::isfinite(zero)) {  // the same everywhere
            if (at_first < 0) end_ = first_;
            return;
        }
        const auto limit = static_cast<float>(inverse_m_.size());
        const auto border = static_cast<Eigen::Index>(std::floor(std::clamp(zero, -1.0f, limit)));
        if (by_step > 0)
            first_ = std::max(first_, border);
        else
            end_ = std::min(end_, border + 2);
    }

    Eigen::ArrayXf inverse_m_, z_, u_, v_, seen_inverse_m_;
    Eigen::ArrayXi fine_, pixel_;
    Eigen::Index first_ = 0, end_ = 0;
};

/// The costs of all depths at one pixel, from the pictures of the other rigs.
class PixelSweep {
  public:
    explicit PixelSweep(const DepthRange& range)
        : line_(range),
          least_(static_cast<std::size_t>(range.depths)),
          second_(least_.size()),
          right_(least_.size()),
          is_hidden_(least_.size()) {}

    void begin() {
        std::fill(least_.begin(), least_.end(), none);
        std::fill(second_.begin(), second_.end(), none);
        std::fill(right_.begin(), right_.end(), none);
        std::fill(is_hidden_.begin(), is_hidden_.end(), std::uint8_t{0});
    }
    void add_other(const Other& other, cv::Point pixel, const cv::Vec4b& colour) {
        line_.project(other, pixel);
        const cv::Vec4b* fine = other.fine[0];
        const cv::Vec2f* has = other.inverse_depths.empty() ? nullptr : other.inverse_depths[0];
        line_.for_each([&](std::size_t k, std::size_t index) {
            const cv::Vec4b& there = fine[index];
            if (there[3] < 255) {  // unknown in part: foreground hides it
                is_hidden_[k] = 1;
                return;
            }
            Cost cost = cost_of(colour, there);
            if (has && !check_consistency(has[line_.pixel(k)], line_.seen_inverse_m(k), cost)) {
                is_hidden_[k] = 1;
                return;
            }
            second_[k] = std::min(second_[k], std::max(least_[k], cost));
            least_[k] = std::min(least_[k], cost);
        });
    }
    /// Adds the rig's own right image.
    void add_right(const Other& right, cv::Point pixel, const cv::Vec4b& colour) {
        line_.project(right, pixel);
        const cv::Vec4b* fine = right.fine[0];
        line_.for_each(
            [&](std::size_t k, std::size_t index) { right_[k] = cost_of(colour, fine[index]); });
        has_right_ = true;
    }
    void end(Cost* costs) const {
        for (std::size_t k = 0; k < least_.size(); ++k) {
            const Cost unchecked = is_hidden_[k] ? hidden_cost : unseen_cost;
            const int first = least_[k] == none ? unchecked : least_[k],
                      second = second_[k] == none ? unchecked : second_[k],
                      others = (first + second) / 2,
                      right = right_[k] == none ? unseen_cost : right_[k];
            costs[k] = static_cast<Cost>(
                has_right_ ? (others * (shares - right_share) + right * right_share) / shares
                           : others);
        }
    }

  private:
    static constexpr Cost none = std::numeric_limits<Cost>::max();

    /// Adjusts the cost of a depth by the least and the greatest inverse depth that the other rig
    /// has there. False if the depth is hidden from that rig.
    static bool check_consistency(const cv::Vec2f& has, float inverse_m, Cost& cost) {
        const float off = surface_share * inverse_m;
        if (std::abs(has[0] - inverse_m) < off || std::abs(has[1] - inverse_m) < off)
            cost /= 2;
        else if (has[0] > inverse_m)
            return false;
        else if (has[1] > 0 && has[1] < inverse_m)
            cost = std::min(static_cast<Cost>(cost + see_through_penalty), whole);
        return true;
    }

    DepthLine line_;
    std::vector<Cost> least_, second_, right_;
    std::vector<std::uint8_t> is_hidden_;
    bool has_right_ = false;
};

// The functions below return early, with an incomplete result, once `stop` is requested.

CostVolume swept(const BackgroundView& view, std::span<const Other> others,
                 const std::optional<Other>& right, const DepthRange& range,
                 const std::stop_token& stop) {
    CostVolume costs(view.colour.size(), range.depths);
    PixelSweep sweep(range);
    for (int y = 0; y < view.colour.rows && !stop.stop_requested(); ++y)
        for (int x = 0; x < view.colour.cols; ++x) {
            sweep.begin();
            if (view.colour(y, x)[3] > 0) {
                for (const Other& other : others) sweep.add_other(other, {x, y}, view.colour(y, x));
                if (right) sweep.add_right(*right, {x, y}, view.colour(y, x));
            }
            sweep.end(costs.at(y, x));
        }
    return costs;
}

/// Averages costs over 3x3 pixels of similar colour and adds the penalty for leaving the rig's own
/// depth.
CostVolume smoothed(const CostVolume& costs, const BackgroundView& view, const DepthRange& range,
                    const std::stop_token& stop) {
    constexpr int all = 64;  // the sum of all weights
    CostVolume smooth(costs.size(), costs.depths());
    const float px_per_inverse_m = static_cast<float>(view.K(0, 0) * view.baseline_m);
    for (int y = 0; y < view.colour.rows && !stop.stop_requested(); ++y)
        for (int x = 0; x < view.colour.cols; ++x) {
            std::array<const Cost*, 9> around{};
            std::array<float, 9> weights{};
            float sum = 0;
            for (int k = 0; k < 9; ++k) {
                const int v = std::clamp(y + k / 3 - 1, 0, view.colour.rows - 1),
                          u = std::clamp(x + k % 3 - 1, 0, view.colour.cols - 1);
                const auto i = static_cast<std::size_t>(k);
                around[i] = costs.at(v, u);
                weights[i] =
                    std::exp(-difference(view.colour(v, u), view.colour(y, x)) / colour_falloff);
                sum += weights[i];
            }
            Cost* to = smooth.at(y, x);
            int left = all;
            for (std::size_t k = 0; k < 9; ++k) {
                if (k == 4) continue;
                const auto weight = static_cast<Cost>(static_cast<float>(all) * weights[k] / sum);
                left -= weight;
                if (weight == 0) continue;
                const Cost* from = around[k];
                for (int depth = 0; depth < costs.depths(); ++depth)
                    to[depth] = static_cast<Cost>(to[depth] + weight * from[depth]);
            }
            const auto weight = static_cast<Cost>(left);
            for (int depth = 0; depth < costs.depths(); ++depth)
                to[depth] = static_cast<Cost>((to[depth] + weight * around[4][depth]) / all);
            const float own = view.depth_m(y, x);
            if (own <= 0 || view.colour(y, x)[3] == 0) continue;
            for (int depth = 0; depth < costs.depths(); ++depth) {
                const float off_px =
                    std::abs(range.at(static_cast<float>(depth)) - 1 / own) * px_per_inverse_m;
                to[depth] = static_cast<Cost>(
                    to[depth] +
                    static_cast<Cost>(own_penalty * std::min(1.0f, off_px / own_reach_px)));
            }
        }
    return smooth;
}

/// The penalty of a jump between two neighbours.
Cost jump_between(const cv::Vec4b& a, const cv::Vec4b& b) {
    const float cost = jump_penalty / (1 + difference(a, b) / halving_difference);
    return std::max(static_cast<Cost>(cost), step_penalty);
}

/// Extends a path by a pixel: `to` = costs + the least of staying, stepping and jumping.
void extend_path(const Cost* costs, const Cost* from, Cost jump_more, Cost* to, int depths) {
    Cost least = from[0];
    for (int depth = 1; depth < depths; ++depth) least = std::min(least, from[depth]);
    const auto jump = static_cast<Cost>(least + jump_more);
    const auto stepped = [&](int depth) { return static_cast<Cost>(from[depth] + step_penalty); };
    to[0] = std::min(std::min(from[0], jump), stepped(1));
    for (int depth = 1; depth < depths - 1; ++depth)
        to[depth] =
            std::min(std::min(from[depth], jump), std::min(stepped(depth - 1), stepped(depth + 1)));
    to[depths - 1] = std::min(std::min(from[depths - 1], jump), stepped(depths - 2));
    for (int depth = 0; depth < depths; ++depth)
        to[depth] = static_cast<Cost>(to[depth] - least + costs[depth]);
}

void add(const Cost* path, Cost* sums, int depths) {
    for (int depth = 0; depth < depths; ++depth)
        sums[depth] = static_cast<Cost>(sums[depth] + path[depth]);
}

/// Adds the costs of the paths along a row, in both directions.
void walk_row(const CostVolume& costs, const ColourImage& colour, CostVolume& sums, int y) {
    const int depths = costs.depths(), last = costs.size().width - 1;
    std::vector<Cost> before(static_cast<std::size_t>(depths)), now(before.size());
    for (const int direction : {1, -1})
        for (int i = 0; i <= last; ++i) {
            const int x = direction > 0 ? i : last - i;
            if (i == 0)
                std::copy_n(costs.at(y, x), depths, now.data());
            else
                extend_path(costs.at(y, x), before.data(),
                            jump_between(colour(y, x), colour(y, x - direction)), now.data(),
                            depths);
            add(now.data(), sums.at(y, x), depths);
            std::swap(before, now);
        }
}

/// Adds the costs of the paths along all columns, down or up.
void walk_columns(const CostVolume& costs, const ColourImage& colour, CostVolume& sums,
                  bool is_down, const std::stop_token& stop) {
    const int depths = costs.depths(), last = costs.size().height - 1;
    CostVolume before({costs.size().width, 1}, depths), now = before;
    for (int i = 0; i <= last && !stop.stop_requested(); ++i) {
        const int y = is_down ? i : last - i;
        for (int x = 0; x < costs.size().width; ++x) {
            if (i == 0)
                std::copy_n(costs.at(y, x), depths, now.at(0, x));
            else
                extend_path(costs.at(y, x), before.at(0, x),
                            jump_between(colour(y, x), colour(is_down ? y - 1 : y + 1, x)),
                            now.at(0, x), depths);
            add(now.at(0, x), sums.at(y, x), depths);
        }
        std::swap(before, now);
    }
}

DepthImage winners(const CostVolume& sums, const BackgroundView& view, const DepthRange& range) {
    DepthImage depth_m(view.colour.size(), 0.0f);
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x) {
            if (view.colour(y, x)[3] == 0) continue;
            const Cost* sum = sums.at(y, x);
            const auto best = static_cast<int>(std::min_element(sum, sum + range.depths) - sum);
            float off = 0;
            if (best > 0 && best < range.depths - 1) {
                const int before = sum[best - 1] - sum[best], after = sum[best + 1] - sum[best];
                if (const int slope = std::max(before, after); slope > 0)
                    off = static_cast<float>(before - after) / static_cast<float>(2 * slope);
            }
            depth_m(y, x) = 1 / range.at(static_cast<float>(best) + off);
        }
    return depth_m;
}

cv::Mat4b finer(const ColourImage& picture) {
    cv::Mat larger;
    cv::resize(picture, larger, {}, fineness, fineness, cv::INTER_CUBIC);
    return larger;
}

/// Scales the channels of the right image to those of the left, over the pixels that the rig's own
/// depth assigns to each other: two sensors differ, and the light may have changed since.
void bring_to_left(const BackgroundView& view, ColourImage& right) {
    const double f_baseline = view.K(0, 0) * view.baseline_m;
    cv::Scalar left_sum, right_sum;
    for (int y = 0; y < right.rows; ++y)
        for (int x = 0; x < right.cols; ++x) {
            const float z = view.depth_m(y, x);
            if (z <= 0 || view.colour(y, x)[3] == 0) continue;
            const long there = std::lround(x - (f_baseline / z - view.doffs_px));
            if (there < 0 || there >= right.cols) continue;
            left_sum += cv::Scalar(view.colour(y, x));
            right_sum += cv::Scalar(right(y, static_cast<int>(there)));
        }
    cv::Scalar gains(1, 1, 1, 1);
    for (int channel = 0; channel < 3; ++channel)
        if (right_sum[channel] > 0) gains[channel] = left_sum[channel] / right_sum[channel];
    cv::multiply(right, gains, right);
}

/// The still image of the right camera, in the size and colours of the left; empty if there are too
/// few images.
ColourImage right_of(const BackgroundView& view) {
    const ColourImage still = still_picture(view.right_jpegs, view.right_px);
    if (still.empty()) return {};
    cv::Mat sized;
    cv::resize(view.right_correction.is_identity() ? still : view.right_correction.apply(still),
               sized, view.colour.size(), 0, 0, cv::INTER_AREA);
    ColourImage right(sized);
    bring_to_left(view, right);
    return right;
}

/// The right image as another view.
Other seen_from(const BackgroundView& view, const ColourImage& right) {
    BackgroundView camera;
    camera.K = view.K;
    camera.K(0, 2) += view.doffs_px;
    camera.world_from_camera = view.world_from_camera * Eigen::Translation3d(view.baseline_m, 0, 0);
    return {other_from_pixel(camera, view).cast<float>(), finer(right), {}};
}

std::optional<DepthImage> matched(std::span<const BackgroundView> views, std::size_t which,
                                  std::span<const cv::Mat4b> fine, const ColourImage& right_picture,
                                  std::span<const cv::Mat2f> inverse_depths,
                                  const std::stop_token& stop) {
    const BackgroundView& view = views[which];
    std::vector<Other> others;
    const std::vector<std::size_t> nearest_others = others_of(views, which);
    others.reserve(nearest_others.size());
    for (const std::size_t i : nearest_others)
        others.push_back({other_from_pixel(views[i], view).cast<float>(), fine[i],
                          inverse_depths.empty() ? cv::Mat2f() : inverse_depths[i]});
    if (others.empty()) return DepthImage(view.colour.size(), 0.0f);
    const DepthRange range = range_of(view, views[nearest_others.front()]);
    if (range.depths == 0) return DepthImage(view.colour.size(), 0.0f);
    std::optional<Other> right;
    if (!right_picture.empty()) right = seen_from(view, right_picture);
    const CostVolume costs = smoothed(swept(view, others, right, range, stop), view, range, stop);
    CostVolume sums(costs.size(), costs.depths());
    walk_columns(costs, view.colour, sums, true, stop);
    walk_columns(costs, view.colour, sums, false, stop);
    for (int y = 0; y < costs.size().height && !stop.stop_requested(); ++y)
        walk_row(costs, view.colour, sums, y);
    if (stop.stop_requested()) return std::nullopt;
    return winners(sums, view, range);
}

}  // namespace

std::optional<std::vector<DepthImage>> match_backgrounds(std::span<const BackgroundView> views,
                                                         const std::stop_token& stop) {
    std::vector<cv::Mat4b> fine;
    std::vector<ColourImage> rights;
    for (const BackgroundView& view : views) {
        fine.push_back(finer(view.colour));
        rights.push_back(right_of(view));
    }
    std::vector<DepthImage> depths_m;
    for (int pass = 0; pass < 2; ++pass) {
        std::vector<cv::Mat2f> inverse_depths;
        inverse_depths.reserve(depths_m.size());
        for (const DepthImage& depth_m : depths_m)
            inverse_depths.push_back(inverse_depths_of(depth_m));
        depths_m.clear();
        for (std::size_t i = 0; i < views.size(); ++i) {
            std::optional<DepthImage> depth_m =
                matched(views, i, fine, rights[i], inverse_depths, stop);
            if (!depth_m) return std::nullopt;
            depths_m.push_back(std::move(*depth_m));
        }
    }
    return depths_m;
}

}  // namespace vantage
