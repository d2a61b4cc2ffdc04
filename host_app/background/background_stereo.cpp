#include "host_app/background/background_stereo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include "host_app/background/label_costs.h"
#include "host_app/background/scene_planes.h"
#include "host_app/background/still_image.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Other rigs that a rig is compared with, at most: the nearest.
constexpr std::size_t max_others = 3;
/// Distance of another rig, in baselines of the rig, from which on it measures depth better than
/// the rig itself.
constexpr double min_apart = 2;

/// Smoothness penalties between neighbours: of a step to the next depth, and of a jump. The jump's
/// is halved at this difference of their colours (0..255).
constexpr Cost step_penalty = 10, jump_penalty = 256;
constexpr float halving_difference = 25;
/// Planes that are tried at each pixel beside the depths, at most, and how far their points may be
/// off, in distances of two depths.
constexpr std::size_t most_planes_tried = 12;
constexpr double plane_tolerance = 0.75;
/// Distance of two depths that are tried, px in the nearest other rig's picture.
constexpr double step_px = 1;
constexpr int min_depths = 16, max_depths = 256;
/// Range of inverse depths. At least these factors of the median, since matchers miss thin objects;
/// beyond that, the range of the rig's depths without these shares of its pixels, with a margin.
constexpr double farthest_tried = 0.4, nearest_tried = 2.2;
constexpr double farther_share = 0.01, nearer_share = 0.002, margin = 1.25;

/// The floor of a stage calibration.
const ScenePlane floor_plane(0, -1, 0, 0);

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
DepthLabels labels_of(const BackgroundView& view, const BackgroundView& nearest) {
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
    DepthLabels labels;
    labels.depths =
        std::isfinite(depths)
            ? static_cast<int>(std::clamp(std::ceil(depths), 1.0 * min_depths, 1.0 * max_depths))
            : max_depths;
    labels.farthest = static_cast<float>(farthest);
    labels.step = static_cast<float>((closest - farthest) / (labels.depths - 1));
    return labels;
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

/// The penalty of a jump between two neighbours.
Cost jump_between(const cv::Vec4b& a, const cv::Vec4b& b) {
    const float cost = jump_penalty / (1 + difference(a, b) / halving_difference);
    return std::max(static_cast<Cost>(cost), step_penalty);
}

/// The depths next to each plane at a pixel, -1 where there is none.
struct PlaneDepths {
    std::array<int, most_planes_tried> at{};
    PlaneDepths(const DepthLabels& labels, int y, int x) {
        for (std::size_t plane = 0; plane < labels.planes.size(); ++plane)
            at[plane] = labels.nearest_to(labels.of_plane(plane, y, x));
    }
};

/// Extends a path by a pixel: `to` = costs + the least of staying, stepping and jumping. A path
/// stays on a plane at no cost, and steps between a plane and the depths next to it.
void extend_path(const Cost* costs, const Cost* from, const PlaneDepths& before,
                 const PlaneDepths& here, Cost jump_more, const DepthLabels& labels, Cost* to) {
    const int depths = labels.depths, count = labels.count();
    Cost least = from[0];
    for (int label = 1; label < count; ++label) least = std::min(least, from[label]);
    const auto jump = static_cast<Cost>(least + jump_more);
    const auto stepped = [&](int label) { return static_cast<Cost>(from[label] + step_penalty); };
    to[0] = std::min(std::min(from[0], jump), stepped(1));
    for (int depth = 1; depth < depths - 1; ++depth)
        to[depth] =
            std::min(std::min(from[depth], jump), std::min(stepped(depth - 1), stepped(depth + 1)));
    to[depths - 1] = std::min(std::min(from[depths - 1], jump), stepped(depths - 2));
    for (int label = depths; label < count; ++label) {
        const auto plane = static_cast<std::size_t>(label - depths);
        to[label] = std::min(from[label], jump);
        if (const int near = before.at[plane]; near >= 0)
            to[label] = std::min(to[label], stepped(near));
        const int near = here.at[plane];
        if (near < 0) continue;
        to[near] = std::min(to[near], stepped(label));
        for (int other = depths; other < count; ++other) {
            const int beside = here.at[static_cast<std::size_t>(other - depths)];
            if (beside >= 0 && std::abs(beside - near) <= 1)
                to[label] = std::min(to[label], stepped(other));
        }
    }
    for (int label = 0; label < count; ++label)
        to[label] = static_cast<Cost>(to[label] - least + costs[label]);
}

void add(const Cost* path, Cost* sums, int labels) {
    for (int label = 0; label < labels; ++label)
        sums[label] = static_cast<Cost>(sums[label] + path[label]);
}

/// Adds the costs of the paths along a row, in both directions.
void walk_row(const CostVolume& costs, const ColourImage& colour, const DepthLabels& labels,
              CostVolume& sums, int y) {
    const int count = costs.labels(), last = costs.size().width - 1;
    std::vector<Cost> before(static_cast<std::size_t>(count)), now(before.size());
    for (const int direction : {1, -1})
        for (int i = 0; i <= last; ++i) {
            const int x = direction > 0 ? i : last - i;
            if (i == 0)
                std::copy_n(costs.at(y, x), count, now.data());
            else
                extend_path(costs.at(y, x), before.data(), {labels, y, x - direction},
                            {labels, y, x}, jump_between(colour(y, x), colour(y, x - direction)),
                            labels, now.data());
            add(now.data(), sums.at(y, x), count);
            std::swap(before, now);
        }
}

/// Adds the costs of the paths along all columns, down or up.
void walk_columns(const CostVolume& costs, const ColourImage& colour, const DepthLabels& labels,
                  CostVolume& sums, bool is_down, const std::stop_token& stop) {
    const int count = costs.labels(), last = costs.size().height - 1;
    CostVolume before({costs.size().width, 1}, count), now = before;
    for (int i = 0; i <= last && !stop.stop_requested(); ++i) {
        const int y = is_down ? i : last - i;
        for (int x = 0; x < costs.size().width; ++x) {
            if (i == 0)
                std::copy_n(costs.at(y, x), count, now.at(0, x));
            else
                extend_path(costs.at(y, x), before.at(0, x), {labels, is_down ? y - 1 : y + 1, x},
                            {labels, y, x},
                            jump_between(colour(y, x), colour(is_down ? y - 1 : y + 1, x)), labels,
                            now.at(0, x));
            add(now.at(0, x), sums.at(y, x), count);
        }
        std::swap(before, now);
    }
}

DepthImage winners(const CostVolume& sums, const BackgroundView& view, const DepthLabels& labels) {
    DepthImage depth_m(view.colour.size(), 0.0f);
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x) {
            if (view.colour(y, x)[3] == 0) continue;
            const Cost* sum = sums.at(y, x);
            const auto best = static_cast<int>(std::min_element(sum, sum + labels.count()) - sum);
            if (best >= labels.depths) {
                depth_m(y, x) = 1 / labels.of_label(best, y, x);
                continue;
            }
            float off = 0;
            if (best > 0 && best < labels.depths - 1) {
                const int before = sum[best - 1] - sum[best], after = sum[best + 1] - sum[best];
                if (const int slope = std::max(before, after); slope > 0)
                    off = static_cast<float>(before - after) / static_cast<float>(2 * slope);
            }
            depth_m(y, x) = 1 / labels.at(static_cast<float>(best) + off);
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
OtherView seen_from(const BackgroundView& view, const ColourImage& right) {
    BackgroundView camera;
    camera.K = view.K;
    camera.K(0, 2) += view.doffs_px;
    camera.world_from_camera = view.world_from_camera * Eigen::Translation3d(view.baseline_m, 0, 0);
    return {other_from_pixel(camera, view).cast<float>(), finer(right), {}};
}

/// The input of both passes: the views at the matched size, their enlarged pictures, and the
/// inverse depths to try before planes are known.
struct Scene {
    std::vector<BackgroundView> views;
    std::vector<ColourImage> rights;               ///< of the views' sizes; empty: there is none
    std::vector<cv::Mat4b> fine;                   ///< the views' pictures, enlarged by `fineness`
    std::vector<std::vector<std::size_t>> others;  ///< the views that each view is compared with
    std::vector<DepthLabels> labels;               ///< without depths if there is nothing to match

    Scene(std::vector<BackgroundView> of, std::vector<ColourImage> of_rights)
        : views(std::move(of)), rights(std::move(of_rights)) {
        for (std::size_t i = 0; i < views.size(); ++i) {
            fine.push_back(finer(views[i].colour));
            others.push_back(others_of(views, i));
            labels.push_back(others[i].empty() ? DepthLabels{}
                                               : labels_of(views[i], views[others[i].front()]));
        }
    }
};

BackgroundView halved(const BackgroundView& whole) {
    BackgroundView view = whole;
    const cv::Size size((whole.colour.cols + 1) / 2, (whole.colour.rows + 1) / 2);
    const double scale_x = 1.0 * size.width / whole.colour.cols,
                 scale_y = 1.0 * size.height / whole.colour.rows;
    view.K = scaled_intrinsics(whole.K, scale_x, scale_y);
    view.doffs_px *= scale_x;
    cv::Mat colour, depth_m;
    cv::resize(whole.colour, colour, size, 0, 0, cv::INTER_AREA);
    view.colour = ColourImage(colour);
    // Mixed with an unknown colour, a colour is unknown too.
    for (cv::Vec4b& pixel : view.colour)
        if (pixel[3] < 255) pixel[3] = 0;
    cv::resize(whole.depth_m, depth_m, size, 0, 0, cv::INTER_NEAREST);
    view.depth_m = DepthImage(depth_m);
    return view;
}

Scene scene_of(std::span<const BackgroundView> views, MatchedSize size) {
    std::vector<BackgroundView> matched;
    std::vector<ColourImage> rights;
    for (const BackgroundView& view : views) {
        rights.push_back(right_of(view));
        matched.push_back(size == MatchedSize::half ? halved(view) : view);
        ColourImage& right = rights.back();
        if (right.empty() || right.size() == matched.back().colour.size()) continue;
        cv::Mat sized;
        cv::resize(right, sized, matched.back().colour.size(), 0, 0, cv::INTER_AREA);
        right = ColourImage(sized);
    }
    return {std::move(matched), std::move(rights)};
}

/// The planes that the matched depths of all rigs show.
std::vector<ScenePlane> planes_in(const Scene& scene, std::span<const DepthImage> depths_m) {
    std::vector<DepthMapView> maps;
    for (std::size_t i = 0; i < depths_m.size(); ++i)
        if (scene.labels[i].depths > 0)
            maps.push_back({scene.views[i].K, scene.views[i].world_from_camera, &depths_m[i],
                            plane_tolerance * scene.labels[i].step});
    if (maps.empty()) return {};
    return planes_of(maps, most_planes_tried, {&floor_plane, 1});
}

/// `inverse_depths` of all views; empty in the first pass.
std::optional<DepthImage> matched(const Scene& scene, std::size_t which,
                                  std::span<const cv::Mat2f> inverse_depths,
                                  std::span<const ScenePlane> planes, const std::stop_token& stop) {
    const BackgroundView& view = scene.views[which];
    DepthLabels labels = scene.labels[which];
    if (labels.depths == 0) return DepthImage(view.colour.size(), 0.0f);
    std::vector<OtherView> others;
    others.reserve(scene.others[which].size());
    for (const std::size_t i : scene.others[which])
        others.push_back({other_from_pixel(scene.views[i], view).cast<float>(), scene.fine[i],
                          inverse_depths.empty() ? cv::Mat2f() : inverse_depths[i]});
    for (const ScenePlane& plane : planes)
        labels.planes.push_back(
            inverse_depth_of(plane, view.K, view.world_from_camera).transpose().cast<float>());
    labels.has_floor = !planes.empty() && planes.front() == floor_plane;
    std::optional<OtherView> right;
    if (!scene.rights[which].empty()) right = seen_from(view, scene.rights[which]);
    const CostVolume costs = smoothed(swept(view, others, right, labels, stop), view, labels, stop);
    CostVolume sums(costs.size(), costs.labels());
    walk_columns(costs, view.colour, labels, sums, true, stop);
    walk_columns(costs, view.colour, labels, sums, false, stop);
    for (int y = 0; y < costs.size().height && !stop.stop_requested(); ++y)
        walk_row(costs, view.colour, labels, sums, y);
    if (stop.stop_requested()) return std::nullopt;
    return winners(sums, view, labels);
}

}  // namespace

std::optional<std::vector<DepthImage>> match_backgrounds(std::span<const BackgroundView> views,
                                                         MatchedSize size,
                                                         const std::stop_token& stop) {
    const Scene scene = scene_of(views, size);
    std::vector<DepthImage> depths_m;
    for (int pass = 0; pass < 2; ++pass) {
        std::vector<cv::Mat2f> inverse_depths;
        inverse_depths.reserve(depths_m.size());
        for (const DepthImage& depth_m : depths_m)
            inverse_depths.push_back(inverse_depths_of(depth_m));
        const std::vector<ScenePlane> planes = planes_in(scene, depths_m);
        depths_m.clear();
        for (std::size_t i = 0; i < views.size(); ++i) {
            std::optional<DepthImage> depth_m = matched(scene, i, inverse_depths, planes, stop);
            if (!depth_m) return std::nullopt;
            depths_m.push_back(std::move(*depth_m));
        }
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (depths_m[i].size() == views[i].colour.size()) continue;
        cv::Mat sized;
        cv::resize(depths_m[i], sized, views[i].colour.size(), 0, 0, cv::INTER_NEAREST);
        depths_m[i] = DepthImage(sized);
    }
    return depths_m;
}

}  // namespace vantage
