#include "host_app/view_sets/outline_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

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

float nearest_hull_depth(const std::vector<OtherOutline>& others, const Eigen::Vector2d& pixel,
                         double nearest_m, double farthest_m) {
    std::vector<Eigen::Vector3d> directions;
    for (const OtherOutline& other : others)
        directions.push_back(other.rotation * pixel.homogeneous());
    const auto is_in_hull = [&](double depth_m) {
        std::ptrdiff_t seen = 0;
        for (std::size_t i = 0; i < others.size(); ++i)
            if (!others[i].may_hold(directions[i], depth_m, seen)) return false;
        return seen >= std::min(least_others, std::ssize(others));
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

}  // namespace

void set_depth_from_outlines(std::vector<DepthView>& views,
                             const std::vector<GreyImage>& outlines) {
    const auto with_outline = std::count_if(outlines.begin(), outlines.end(),
                                            [](const GreyImage& one) { return !one.empty(); });
    if (with_outline < 2)
        fail("a hull needs the outlines of at least two views, and {} of {} have one", with_outline,
             views.size());
    const Eigen::Vector3d middle = middle_of(views);
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (outlines[i].empty()) continue;
        DepthView& view = views[i];
        const double distance_m =
            (view.world_from_camera.inverse() * middle).norm() + std::numeric_limits<float>::min();
        std::vector<OtherOutline> others;
        for (std::size_t k = 0; k < views.size(); ++k) {
            if (k == i || outlines[k].empty()) continue;
            const Pose other_from_this =
                views[k].world_from_camera.inverse() * view.world_from_camera;
            others.push_back({&outlines[k],
                              views[k].K * other_from_this.linear() * view.K.inverse(),
                              views[k].K * other_from_this.translation()});
        }
        view.depth_m = DepthImage(outlines[i].size(), 0.0f);
        for (int y = 0; y < view.depth_m.rows; ++y)
            for (int x = 0; x < view.depth_m.cols; ++x)
                if (outlines[i](y, x) >= least_inside)
                    view.depth_m(y, x) = nearest_hull_depth(
                        others, {x, y}, nearest_share * distance_m, farthest_share * distance_m);
    }
}

}  // namespace vantage
