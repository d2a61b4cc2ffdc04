#include "host_app/background/label_costs.h"

#include <algorithm>
#include <array>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "host_app/views/tolerances.h"

namespace vantage {
namespace {

constexpr Cost whole = 256;  ///< the largest cost of one comparison
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
/// Cost of a depth that is hidden on a plain surface, in place of hidden_cost: the surface that
/// hides it may be wrong, since rigs confirm each other's errors where nothing differs.
constexpr Cost plain_hidden_cost = 20;
/// A surface is plain where the colours of neighbours in a row differ by less than this (0..255),
/// within so many pixels. In between, the cost is in between.
constexpr float textured_step = 24;
constexpr int texture_reach_px = 2;
/// Penalty of a depth that is own_reach_px or more of the rig's own disparity away from its
/// matcher's.
constexpr float own_penalty = 50, own_reach_px = 2;
/// Penalty of a depth that is not on a plane, and of all but the floor: on a plain surface nothing
/// else decides, and floors are large.
constexpr Cost no_plane_penalty = 4, no_floor_penalty = 6;
/// Cost of a plane where it is not before the camera, or outside the range.
constexpr Cost not_there = 1000;
/// Pixels are swept by blocks of this size: what they read of other pictures stays in the
/// processor's cache.
constexpr int block_px = 16;
/// Costs are averaged over 3x3 pixels; mean difference (0..255) at which a weight falls to 1/e.
constexpr float colour_falloff = 15;

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
    explicit DepthLine(const DepthLabels& labels)
        : labels_(labels),
          inverse_m_(labels.count()),
          z_(labels.count()),
          u_(labels.count()),
          v_(labels.count()),
          seen_inverse_m_(labels.count()),
          fine_(labels.count()),
          pixel_(labels.count()) {
        for (int k = 0; k < labels.depths; ++k) inverse_m_[k] = labels.at(static_cast<float>(k));
    }

    void project(const OtherView& other, cv::Point from_pixel) {
        const Eigen::Vector4f along =
            other.from_pixel * Eigen::Vector4f(static_cast<float>(from_pixel.x),
                                               static_cast<float>(from_pixel.y), 1, 0);
        const Eigen::Vector4f from = other.from_pixel.col(3);
        const auto right = static_cast<float>(other.columns() - 1),
                   bottom = static_cast<float>(other.rows() - 1);
        // Being before the camera and within its picture are inequalities that are linear in the
        // inverse depth. Rounding errors at the ends are corrected below.
        first_ = 0;
        end_ = labels_.depths;
        place_planes(other, along, from, from_pixel);
        keep(along.z(), from.z());
        keep(along.x(), from.x());
        keep(along.y(), from.y());
        keep(right * along.z() - along.x(), right * from.z() - from.x());
        keep(bottom * along.z() - along.y(), bottom * from.z() - from.y());
        if (first_ >= end_) return;
        place(along, from, first_, end_ - first_);
        while (first_ < end_ && !is_inside(other, first_)) ++first_;
        while (first_ < end_ && !is_inside(other, end_ - 1)) --end_;
        if (first_ < end_) find_pixels(other, first_, end_ - first_);
    }
    /// Calls read(label, index in the enlarged picture) for the labels that lie in the picture.
    template <class Read>
    void for_each(const Read& read) const {
        for (Eigen::Index k = first_; k < end_; ++k)
            read(static_cast<std::size_t>(k), static_cast<std::size_t>(fine_[k]));
        for (Eigen::Index k = labels_.depths; k < inverse_m_.size(); ++k)
            if (fine_[k] >= 0)
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
    /// Computes z and the place in the picture for some labels.
    void place(const Eigen::Vector4f& along, const Eigen::Vector4f& from, Eigen::Index first,
               Eigen::Index count) {
        const auto inverse_m = inverse_m_.segment(first, count);
        auto z = z_.segment(first, count);
        z = along.z() + inverse_m * from.z();
        u_.segment(first, count) = (along.x() + inverse_m * from.x()) / z;
        v_.segment(first, count) = (along.y() + inverse_m * from.y()) / z;
    }
    bool is_inside(const OtherView& other, Eigen::Index label) const {
        return z_[label] > 0 && u_[label] >= 0 && v_[label] >= 0 &&
               u_[label] <= static_cast<float>(other.columns() - 1) &&
               v_[label] <= static_cast<float>(other.rows() - 1);
    }
    void find_pixels(const OtherView& other, Eigen::Index first, Eigen::Index count) {
        const auto
            u = u_.segment(first, count).max(0.0f).min(static_cast<float>(other.columns() - 1)),
            v = v_.segment(first, count).max(0.0f).min(static_cast<float>(other.rows() - 1));
        fine_.segment(first, count) = (fineness * (v + 0.5f)).cast<int>() * other.fine.cols +
                                      (fineness * (u + 0.5f)).cast<int>();
        if (other.inverse_depths.empty()) return;
        pixel_.segment(first, count) = v.cast<int>() * other.columns() + u.cast<int>();
        seen_inverse_m_.segment(first, count) =
            inverse_m_.segment(first, count) / z_.segment(first, count);
    }
    /// The planes' labels; fine_ is -1 for those outside the picture.
    void place_planes(const OtherView& other, const Eigen::Vector4f& along,
                      const Eigen::Vector4f& from, cv::Point pixel) {
        for (Eigen::Index label = labels_.depths; label < inverse_m_.size(); ++label) {
            inverse_m_[label] = labels_.of_label(static_cast<int>(label), pixel.y, pixel.x);
            const Eigen::Vector3f at = along.head<3>() + inverse_m_[label] * from.head<3>();
            fine_[label] = -1;
            if (inverse_m_[label] <= 0 || at.z() <= 0) continue;
            z_[label] = at.z();
            u_[label] = at.x() / at.z();
            v_[label] = at.y() / at.z();
            if (is_inside(other, label)) find_pixels(other, label, 1);
        }
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
        const auto limit = static_cast<float>(labels_.depths);
        const auto border = static_cast<Eigen::Index>(std::floor(std::clamp(zero, -1.0f, limit)));
        if (by_step > 0)
            first_ = std::max(first_, border);
        else
            end_ = std::min(end_, border + 2);
    }

    const DepthLabels& labels_;
    Eigen::ArrayXf inverse_m_, z_, u_, v_, seen_inverse_m_;
    Eigen::ArrayXi fine_, pixel_;
    Eigen::Index first_ = 0, end_ = 0;
};

/// The costs of all depths at one pixel, from the pictures of the other rigs.
class PixelSweep {
  public:
    explicit PixelSweep(const DepthLabels& labels)
        : line_(labels),
          least_(static_cast<std::size_t>(labels.count())),
          second_(least_.size()),
          right_(least_.size()),
          is_hidden_(least_.size()) {}

    void begin() {
        std::fill(least_.begin(), least_.end(), none);
        std::fill(second_.begin(), second_.end(), none);
        std::fill(right_.begin(), right_.end(), none);
        std::fill(is_hidden_.begin(), is_hidden_.end(), std::uint8_t{0});
    }
    /// `texture`: 0 on a plain surface to 1.
    void add_other(const OtherView& other, cv::Point pixel, const cv::Vec4b& colour,
                   float texture) {
        const auto hidden = static_cast<Cost>(
            plain_hidden_cost + texture * static_cast<float>(hidden_cost - plain_hidden_cost));
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
                cost = static_cast<Cost>(cost + hidden);
                if (cost >= hidden_cost) return;
            }
            second_[k] = std::min(second_[k], std::max(least_[k], cost));
            least_[k] = std::min(least_[k], cost);
        });
    }
    /// Adds the rig's own right image.
    void add_right(const OtherView& right, cv::Point pixel, const cv::Vec4b& colour) {
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

/// How much the colours around each pixel differ along the row: 0 on a plain surface to 1.
cv::Mat1f texture_of(const ColourImage& colour) {
    cv::Mat1f steps(colour.size(), 0.0f), texture;
    for (int y = 0; y < colour.rows; ++y)
        for (int x = 1; x < colour.cols; ++x)
            steps(y, x) =
                std::min(difference(colour(y, x), colour(y, x - 1)) / textured_step, 1.0f);
    cv::dilate(steps, texture,
               cv::Mat::ones(2 * texture_reach_px + 1, 2 * texture_reach_px + 1, CV_8U));
    return texture;
}

/// The cost of a label itself, at every pixel.
Cost penalty_of(int label, const DepthLabels& labels) {
    int penalty = 0;
    if (!labels.planes.empty() && label < labels.depths) penalty += no_plane_penalty;
    if (labels.has_floor && label != labels.depths) penalty += no_floor_penalty;
    return static_cast<Cost>(penalty);
}

}  // namespace

CostVolume swept(const BackgroundView& view, std::span<const OtherView> others,
                 const std::optional<OtherView>& right, const DepthLabels& labels,
                 const std::stop_token& stop) {
    CostVolume costs(view.colour.size(), labels.count());
    PixelSweep sweep(labels);
    const cv::Mat1f texture = texture_of(view.colour);
    const auto sweep_pixel = [&](int y, int x) {
        sweep.begin();
        if (view.colour(y, x)[3] > 0) {
            for (const OtherView& other : others)
                sweep.add_other(other, {x, y}, view.colour(y, x), texture(y, x));
            if (right) sweep.add_right(*right, {x, y}, view.colour(y, x));
        }
        sweep.end(costs.at(y, x));
    };
    const cv::Rect picture({0, 0}, view.colour.size());
    for (int top = 0; top < picture.height && !stop.stop_requested(); top += block_px)
        for (int left = 0; left < picture.width; left += block_px) {
            const cv::Rect block = picture & cv::Rect(left, top, block_px, block_px);
            for (int y = block.y; y < block.br().y; ++y)
                for (int x = block.x; x < block.br().x; ++x) sweep_pixel(y, x);
        }
    return costs;
}

CostVolume smoothed(const CostVolume& costs, const BackgroundView& view, const DepthLabels& labels,
                    const std::stop_token& stop) {
    constexpr int all = 64;  // the sum of all weights
    CostVolume smooth(costs.size(), costs.labels());
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
                for (int label = 0; label < labels.count(); ++label)
                    to[label] = static_cast<Cost>(to[label] + weight * from[label]);
            }
            const auto weight = static_cast<Cost>(left);
            for (int label = 0; label < labels.count(); ++label)
                to[label] = static_cast<Cost>((to[label] + weight * around[4][label]) / all);
            for (int label = labels.depths; label < labels.count(); ++label)
                if (labels.nearest_to(labels.of_label(label, y, x)) < 0) to[label] = not_there;
            for (int label = 0; label < labels.count(); ++label)
                to[label] = static_cast<Cost>(to[label] + penalty_of(label, labels));
            const float own = view.depth_m(y, x);
            if (own <= 0 || view.colour(y, x)[3] == 0) continue;
            for (int label = 0; label < labels.count(); ++label) {
                const float off_px =
                    std::abs(labels.of_label(label, y, x) - 1 / own) * px_per_inverse_m;
                to[label] = static_cast<Cost>(
                    to[label] +
                    static_cast<Cost>(own_penalty * std::min(1.0f, off_px / own_reach_px)));
            }
        }
    return smooth;
}

}  // namespace vantage
