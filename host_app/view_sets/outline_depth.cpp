#include "host_app/view_sets/outline_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/LU>
#include <opencv2/core/utility.hpp>

#include "common/base/error.h"
#include "common/geometry/axis_crossing.h"

namespace vantage {
namespace {

constexpr unsigned char least_inside = 128;
/// Range of depth that is searched, relative to the distance of the middle of the views.
constexpr double nearest_share = 0.2, farthest_share = 4;
constexpr int coarse_steps = 400, fine_steps = 6;
/// Other views, at most, that have to see a point within their outlines. One would not do: a view
/// from the opposite side sees almost a whole line of sight within its outline, and near the camera
/// the views from aside see nothing of it.
constexpr std::ptrdiff_t least_others = 2;

/// Another view's outline along the lines of sight of one view.
struct OtherOutline {
    const GreyImage* outline;
    Eigen::Matrix3d rotation;  ///< its pixels from this view's pixels
    Eigen::Vector3d offset;

    /// Whether the point may be foreground: it is inside the outline, or outside the picture, about
    /// which this view says nothing. `seen` counts the views of the first case.
    bool may_hold(const Eigen::Vector3d& direction, double depth_m, std::ptrdiff_t& seen) const {
        const Eigen::Vector3d p = depth_m * direction + offset;
        if (!(p.z() > 0)) return true;
        const double x = p.x() / p.z() + 0.5, y = p.y() / p.z() + 0.5;
        if (!(x >= 0 && y >= 0 && x < outline->cols && y < outline->rows)) return true;
        const bool is_inside = (*outline)(static_cast<int>(y), static_cast<int>(x)) >= least_inside;
        if (is_inside) ++seen;
        return is_inside;
    }
};

Eigen::Vector3d middle_of(const std::vector<DepthView>& views) {
    AxisCrossing axes;
    for (const DepthView& view : views) axes.add(view.world_from_camera);
    constexpr double for_parallel_axes = 1e-9;
    return axes.point(for_parallel_axes);
}

/// The outlines of all views but `except`, as a camera with this matrix and pose looks at them.
std::vector<OtherOutline> outlines_seen_by(const Eigen::Matrix3d& K, const Pose& world_from_camera,
                                           const std::vector<DepthView>& views,
                                           const std::vector<GreyImage>& outlines,
                                           const DepthView* except) {
    std::vector<OtherOutline> others;
    for (std::size_t k = 0; k < views.size(); ++k) {
        if (&views[k] == except || outlines[k].empty()) continue;
        const Pose other_from_this = views[k].world_from_camera.inverse() * world_from_camera;
        others.push_back({&outlines[k], views[k].K * other_from_this.linear() * K.inverse(),
                          views[k].K * other_from_this.translation()});
    }
    return others;
}

double distance_of_middle(const std::vector<DepthView>& views, const Pose& world_from_camera) {
    return (world_from_camera.inverse() * middle_of(views)).norm() +
           std::numeric_limits<float>::min();
}

float nearest_hull_depth(const std::vector<OtherOutline>& others, const Eigen::Vector2d& pixel,
                         double distance_m, std::ptrdiff_t least_seen) {
    const double nearest_m = nearest_share * distance_m, farthest_m = farthest_share * distance_m;
    std::vector<Eigen::Vector3d> directions;
    for (const OtherOutline& other : others)
        directions.push_back(other.rotation * pixel.homogeneous());
    const auto is_in_hull = [&](double depth_m) {
        std::ptrdiff_t seen = 0;
        for (std::size_t i = 0; i < others.size(); ++i)
            if (!others[i].may_hold(directions[i], depth_m, seen)) return false;
        return seen >= std::min(least_seen, std::ssize(others));
    };
    // Equal steps of disparity: equal steps in the other pictures.
    double outside_m = nearest_m;
    for (int step = 0; step <= coarse_steps; ++step) {
        const double share = static_cast<double>(step) / coarse_steps;
        const double depth_m = 1 / ((1 - share) / nearest_m + share / farthest_m);
        if (!is_in_hull(depth_m)) {
            outside_m = depth_m;
            continue;
        }
        double inside_m = depth_m;
        for (int i = 0; i < fine_steps && step > 0; ++i) {
            const double middle_m = (outside_m + inside_m) / 2;
            (is_in_hull(middle_m) ? inside_m : outside_m) = middle_m;
        }
        return static_cast<float>(inside_m);
    }
    return 0;
}

/// A view that gives the hull its colours.
struct ShadingView {
    ShadingView(const DepthView& shown, const VirtualView& target)
        : view(&shown),
          view_from_target(shown.world_from_camera.inverse() * target.world_from_camera) {}

    /// The colour of a point in the target's frame, weighted by how nearly the view and the target
    /// look in one direction; weight 0 where something stands before it.
    cv::Vec4f weighted_colour(const Eigen::Vector3d& point, double& weight) const {
        const Eigen::Vector3d p = view_from_target * point;
        weight = 0;
        if (!(p.z() > 0)) return {};
        const Eigen::Vector3d pixel = view->K * (p / p.z());
        const int x = static_cast<int>(std::lround(pixel.x())),
                  y = static_cast<int>(std::lround(pixel.y()));
        if (x < 0 || y < 0 || x >= view->depth_m.cols || y >= view->depth_m.rows) return {};
        if (!is_surface(x, y, p.z())) return {};
        const double cosine = p.normalized().dot(view_from_target.linear() * point.normalized());
        constexpr double sharpness = 8, least_weight = 1e-6;
        weight = std::pow(std::max(cosine, 0.0), sharpness) + least_weight;
        return cv::Vec4f(view->colour(y, x)) * static_cast<float>(weight);
    }

    const DepthView* view;
    Pose view_from_target;

  private:
    /// Whether the view sees a point of this depth, up to the steps of both depths. At an outline
    /// the neighbours count too.
    bool is_surface(int x, int y, double depth_m) const {
        constexpr double tolerance = 0.02;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, view->depth_m.rows - 1); ++v)
            for (int u = std::max(x - 1, 0); u <= std::min(x + 1, view->depth_m.cols - 1); ++u)
                if (std::abs(view->depth_m(v, u) - depth_m) < tolerance * depth_m) return true;
        return false;
    }
};

std::optional<cv::Vec4b> shaded(const std::vector<ShadingView>& views,
                                const Eigen::Vector3d& point) {
    cv::Vec4f sum(0, 0, 0, 0);
    double weights = 0;
    for (const ShadingView& view : views) {
        double weight = 0;
        sum += view.weighted_colour(point, weight);
        weights += weight;
    }
    if (weights == 0) return std::nullopt;
    return cv::Vec4b(sum * static_cast<float>(1 / weights));
}

}  // namespace

void set_depth_from_outlines(std::vector<DepthView>& views,
                             const std::vector<GreyImage>& outlines) {
    const auto with_outline = std::count_if(outlines.begin(), outlines.end(),
                                            [](const GreyImage& one) { return !one.empty(); });
    if (with_outline < 2)
        fail("a hull needs the outlines of at least two views, and {} of {} have one", with_outline,
             views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (outlines[i].empty()) continue;
        DepthView& view = views[i];
        const double distance_m = distance_of_middle(views, view.world_from_camera);
        const std::vector<OtherOutline> others =
            outlines_seen_by(view.K, view.world_from_camera, views, outlines, &view);
        view.depth_m = DepthImage(outlines[i].size(), 0.0f);
        for (int y = 0; y < view.depth_m.rows; ++y)
            for (int x = 0; x < view.depth_m.cols; ++x)
                if (outlines[i](y, x) >= least_inside)
                    view.depth_m(y, x) =
                        nearest_hull_depth(others, {x, y}, distance_m, least_others);
    }
}

DepthView hull_view(const std::vector<DepthView>& views, const std::vector<GreyImage>& outlines,
                    const VirtualView& target) {
    DepthView hull;
    hull.name = "hull";
    hull.K = target.K;
    hull.world_from_camera = target.world_from_camera;
    const cv::Size size(target.width_px, target.height_px);
    hull.depth_m = DepthImage(size, 0.0f);
    hull.colour = ColourImage(size, cv::Vec4b(0, 0, 0, 255));
    const double distance_m = distance_of_middle(views, target.world_from_camera);
    const std::vector<OtherOutline> others =
        outlines_seen_by(target.K, target.world_from_camera, views, outlines, nullptr);
    std::vector<ShadingView> shading;
    for (const DepthView& view : views)
        if (view.has_depth()) shading.emplace_back(view, target);
    cv::parallel_for_({0, size.height}, [&](const cv::Range& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < size.width; ++x) {
                const float depth_m =
                    nearest_hull_depth(others, {x, y}, distance_m, least_others + 1);
                if (depth_m == 0) continue;
                // A point that no view sees stays unknown.
                if (const auto colour =
                        shaded(shading, depth_m * hull.K.inverse() * Eigen::Vector3d(x, y, 1))) {
                    hull.colour(y, x) = *colour;
                    hull.depth_m(y, x) = depth_m;
                }
            }
    });
    return hull;
}

}  // namespace vantage
