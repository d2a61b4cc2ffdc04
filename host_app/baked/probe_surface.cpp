#include "host_app/baked/probe_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "host_app/views/projection.h"
#include "host_app/views/tolerances.h"

namespace vantage {
namespace {

constexpr int most_rigs = 4;

// The costs of a surface at a pixel, relative to each other.
constexpr float see_through_cost = 1;  ///< for each rig that sees through it
constexpr float support_gain = 1;      ///< for each rig that has it
constexpr float inpainted_gain = 0.25f;
constexpr float colour_cost = 1;       ///< where its colours differ
constexpr float other_colour = 0.12f;  ///< mean difference of such colours, 0..1
/// The nearest of several surfaces counts if it costs at most so much more than the cheapest:
/// otherwise poles and railings come apart into dashes.
constexpr float nearer_gain = 1.2f;

/// Width of a picture's border, as a share of the picture, in which a rig counts less.
constexpr float border = 0.04f;

float smoothstep(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

float mean_of(const cv::Vec3f& v) { return (std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2])) / 3; }

/// A rig's view of a point that none of its own surfaces hides.
struct Sight {
    float has = 0;    ///< 0..1, whether its own depth there is that of the point
    float clear = 0;  ///< 0..1, the share of its pixels there that show the point's surface
    bool is_measured = false;  ///< its own depth is not inpainted
    bool sees_through = false;
    float weight = 0;       ///< by the angle to the probe's line of sight and by the border
    cv::Vec3f colour = {};  ///< 0..1
    float confidence = 0;   ///< of the colour, 0..1

    /// How much the colour counts. Beside a thing that stands before the surface it is a mixture,
    /// which only counts where no other rig sees the point.
    float visibility() const {
        constexpr float least = 0.01f;
        return std::max(clear * clear * clear * clear, least * has);
    }
};

/// The four pixels of a picture around a place, with their shares in it.
struct FourPixels {
    int x[2], y[2];
    float across, down;  ///< of the second column and the second row

    FourPixels(float u, float v, cv::Size size) {
        const float left = std::floor(u), top = std::floor(v);
        across = u - left;
        down = v - top;
        for (int k = 0; k < 2; ++k) {
            x[k] = std::clamp(static_cast<int>(left) + k, 0, size.width - 1);
            y[k] = std::clamp(static_cast<int>(top) + k, 0, size.height - 1);
        }
    }
    float share(int k) const {
        return (k % 2 == 1 ? across : 1 - across) * (k / 2 == 1 ? down : 1 - down);
    }
    cv::Point pixel(int k) const { return {x[k % 2], y[k / 2]}; }
};

/// One rig, looked at from the probe.
class SeeingRig {
  public:
    SeeingRig(const BackgroundPicture& rig, const VirtualView& view)
        : rig_(&rig),
          from_probe_(pixel_from_target_pixel(rig.camera, view).cast<float>()),
          centre_((view.world_from_camera.inverse() * rig.camera.world_from_camera.translation())
                      .cast<float>()),
          spread_(depth_spread(rig.camera)) {}

    /// Up to which relative difference two depths are one surface.
    float tolerance(float z) const { return same_surface_share + spread_ * z; }
    /// The weight of this rig for a point by the angle between its line of sight and the probe's.
    float closeness(const Eigen::Vector3f& point) const {
        return 1 / (1 - point.normalized().dot((point - centre_).normalized()) + 1e-5f);
    }

    /// Looks at the point of a pixel of the probe; nothing if it lies outside the picture, or
    /// behind a surface of this rig.
    std::optional<Sight> look(cv::Point pixel, const Eigen::Vector3f& point) const {
        const float z = point.z();
        const Eigen::Vector4f q =
            from_probe_ *
            Eigen::Vector4f(static_cast<float>(pixel.x) * z, static_cast<float>(pixel.y) * z, z, 1);
        if (q.z() <= 0) return std::nullopt;
        const cv::Size size = rig_->colour.size(), depths = rig_->depth_m.size();
        const float u = (q.x() / q.z() + 0.5f) / static_cast<float>(size.width),
                    v = (q.y() / q.z() + 0.5f) / static_cast<float>(size.height);
        const float inside = std::min(std::min(u, 1 - u), std::min(v, 1 - v));
        if (inside < 0) return std::nullopt;
        Sight sight;
        const FourPixels around(u * static_cast<float>(depths.width) - 0.5f,
                                v * static_cast<float>(depths.height) - 0.5f, depths);
        const float off_by = tolerance(q.z());
        float least_off = std::numeric_limits<float>::infinity();
        bool is_hidden = true;
        sight.sees_through = true;
        for (int k = 0; k < 4; ++k) {
            const float there = rig_->depth_m(around.pixel(k));
            const float off = (std::abs(there) / q.z() - 1) / off_by;
            if (std::abs(off) < least_off) {
                least_off = std::abs(off);
                sight.is_measured = there > 0;
            }
            is_hidden = is_hidden && off < -2;
            sight.sees_through = sight.sees_through && off > 2 && there > 0;
            sight.clear += around.share(k) * (1 - smoothstep(1, 2, std::abs(off)));
        }
        if (is_hidden) return std::nullopt;
        sight.has = 1 - smoothstep(1, 2, least_off);
        sight.weight = closeness(point) * (smoothstep(0, border, inside) + 0.001f);
        const FourPixels colours(u * static_cast<float>(size.width) - 0.5f,
                                 v * static_cast<float>(size.height) - 0.5f, size);
        cv::Vec4f colour = {};
        for (int k = 0; k < 4; ++k)
            colour += colours.share(k) / 255 * cv::Vec4f(rig_->colour(colours.pixel(k)));
        sight.colour = {colour[0], colour[1], colour[2]};
        sight.confidence = colour[3];
        return sight;
    }

  private:
    const BackgroundPicture* rig_;
    Eigen::Matrix4f from_probe_;
    Eigen::Vector3f centre_;
    float spread_;
};

class SurfaceChoice {
  public:
    SurfaceChoice(const VirtualView& view, const cv::Mat4f& candidates_m,
                  std::span<const std::shared_ptr<const BackgroundPicture>> rigs)
        : candidates_m_(candidates_m), ray_from_pixel_(view.K.inverse().cast<float>()) {
        for (const auto& rig : rigs) rigs_.emplace_back(*rig, view);
    }

    /// The distance of the surface that counts at a pixel, metres; 0 if there is none.
    float choose(cv::Point pixel) const {
        const cv::Vec4f& candidates = candidates_m_(pixel);
        float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
        for (int k = 0; k < most_rigs; ++k) {
            if (candidates[k] <= 0) continue;
            nearest = std::min(nearest, candidates[k]);
            farthest = std::max(farthest, candidates[k]);
        }
        if (farthest == 0) return 0;
        // Most pixels have one surface, and costs take time.
        if (farthest > (1 + rigs_.front().tolerance(nearest)) * nearest)
            nearest = nearest_of_cheap(pixel, candidates);
        return mean_of_rigs(pixel, nearest);
    }

    /// Enters a surface at a pixel with its colour and the rigs that see it.
    void show(cv::Point pixel, float z, ProbeSurface& into) const {
        const Sights sights = look(pixel, z);
        cv::Vec3f sum = {};
        float weights = 0;
        bool is_measured = false;
        for (std::size_t i = 0; i < rigs_.size(); ++i) {
            if (!sights[i] || sights[i]->has <= 0) continue;
            const float visibility = sights[i]->visibility();
            const float w = sights[i]->weight * visibility * (sights[i]->confidence + 0.001f);
            sum += w * sights[i]->colour;
            weights += w;
            is_measured = is_measured || sights[i]->is_measured;
            into.visibility(pixel)[static_cast<int>(i)] =
                cv::saturate_cast<uchar>(255 * visibility);
        }
        if (weights <= 0) return;
        into.depth_m(pixel) = is_measured ? z : -z;
        const cv::Vec3f colour = sum * (255 / weights);
        into.colour(pixel) =
            cv::Vec4b(cv::saturate_cast<uchar>(colour[0]), cv::saturate_cast<uchar>(colour[1]),
                      cv::saturate_cast<uchar>(colour[2]), 255);
    }

  private:
    using Sights = std::array<std::optional<Sight>, most_rigs>;

    Eigen::Vector3f point(cv::Point pixel, float z) const {
        return z * (ray_from_pixel_ *
                    Eigen::Vector3f(static_cast<float>(pixel.x), static_cast<float>(pixel.y), 1));
    }
    Sights look(cv::Point pixel, float z) const {
        Sights sights;
        for (std::size_t i = 0; i < rigs_.size(); ++i)
            sights[i] = rigs_[i].look(pixel, point(pixel, z));
        return sights;
    }

    float nearest_of_cheap(cv::Point pixel, const cv::Vec4f& candidates) const {
        constexpr float infinite = std::numeric_limits<float>::infinity();
        cv::Vec4f costs = cv::Vec4f::all(infinite);
        float least = infinite, nearest = infinite;
        for (int k = 0; k < most_rigs; ++k)
            if (candidates[k] > 0) least = std::min(least, costs[k] = cost(pixel, candidates[k]));
        for (int k = 0; k < most_rigs; ++k)
            if (costs[k] <= least + nearer_gain) nearest = std::min(nearest, candidates[k]);
        return nearest;
    }

    float cost(cv::Point pixel, float z) const {
        const Sights sights = look(pixel, z);
        float most = 0;
        for (const auto& sight : sights)
            if (sight) most = std::max(most, sight->weight);
        if (most <= 0) return 0;
        // Depth errors grow with the angle to a rig.
        const auto say = [most](const Sight& sight) { return std::sqrt(sight.weight / most); };
        float cost = 0, weights = 0;
        cv::Vec3f colour = {};
        for (const auto& sight : sights) {
            if (!sight) continue;
            if (sight->has > 0)
                cost -=
                    say(*sight) * sight->has * (sight->is_measured ? support_gain : inpainted_gain);
            else if (sight->sees_through)
                cost += say(*sight) * see_through_cost;
            const float w = sight->weight * (sight->has + 0.001f);
            colour += w * sight->colour;
            weights += w;
        }
        colour /= weights;
        float differs = 0, says = 0;
        for (const auto& sight : sights) {
            if (!sight) continue;
            differs += say(*sight) * std::min(mean_of(sight->colour - colour) / other_colour, 1.0f);
            says += say(*sight);
        }
        return cost + colour_cost * differs / says;
    }

    /// The mean of the rigs that have a surface at a distance.
    float mean_of_rigs(cv::Point pixel, float z) const {
        float sum = 0, weights = 0;
        for (std::size_t k = 0; k < rigs_.size(); ++k) {
            const float its = candidates_m_(pixel)[static_cast<int>(k)];
            if (its <= 0) continue;
            const float w = rigs_[k].closeness(point(pixel, its)) *
                            (1 - smoothstep(1, 2, std::abs(its / z - 1) / rigs_[k].tolerance(z)));
            sum += w * its;
            weights += w;
        }
        return sum / weights;
    }

    const cv::Mat4f& candidates_m_;
    Eigen::Matrix3f ray_from_pixel_;
    std::vector<SeeingRig> rigs_;
};

}  // namespace

ProbeSurface probe_surface(const VirtualView& view, const cv::Mat4f& candidates_m,
                           std::span<const std::shared_ptr<const BackgroundPicture>> rigs) {
    const SurfaceChoice choice(view, candidates_m, rigs);
    ProbeSurface surface{DepthImage(candidates_m.size(), 0.0f),
                         ColourImage(candidates_m.size(), cv::Vec4b()),
                         cv::Mat4b(candidates_m.size(), cv::Vec4b()),
                         {}};
    for (int y = 0; y < candidates_m.rows; ++y)
        for (int x = 0; x < candidates_m.cols; ++x)
            if (const float z = choice.choose({x, y}); z > 0) choice.show({x, y}, z, surface);
    for (const auto& rig : rigs) surface.rigs.push_back(rig->camera.name);
    return surface;
}

}  // namespace vantage
