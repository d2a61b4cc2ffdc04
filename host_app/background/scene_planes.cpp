#include "host_app/background/scene_planes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace vantage {
namespace {

/// Windows that propose planes: one in so many pixels along each axis, of so many pixels to each
/// side.
constexpr int window_step_px = 8, window_reach_px = 5;
/// Share of a window's points that must be on its plane.
constexpr double plane_share = 0.85;
/// One point in so many pixels along each axis decides between planes.
constexpr int point_step_px = 3;
/// Proposals that are compared for each plane, and the share of the points that it must cover.
constexpr std::size_t max_compared = 300;
constexpr double min_share = 0.01;
/// Share of the points that an expected plane must cover.
constexpr double expected_share = 0.05;
/// Least-squares fits of a chosen plane to its points.
constexpr int fits = 3;

struct Point {
    std::size_t view = 0;
    Eigen::Vector2d pixel;
    double inverse_m = 0;
};

/// A plane and the middle of the window that it is from.
struct Proposal {
    ScenePlane plane;
    Point middle;
};

Eigen::Vector3d homogeneous(const Eigen::Vector2d& pixel) { return {pixel.x(), pixel.y(), 1}; }

/// The plane of a camera's inverse depth.
ScenePlane plane_of(const Eigen::RowVector3d& inverse_depth, const DepthMapView& view) {
    const Eigen::Vector3d in_camera = (inverse_depth * view.K).transpose();
    const Eigen::Vector3d normal = view.world_from_camera.linear() * in_camera;
    ScenePlane plane;
    plane << normal, -1 - normal.dot(view.world_from_camera.translation());
    return plane / normal.norm();
}

/// The factors of the inverse depth that fit some points of one view best.
Eigen::RowVector3d fitted(std::span<const Point> points) {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d products = Eigen::Vector3d::Zero();
    for (const Point& point : points) {
        const Eigen::Vector3d at = homogeneous(point.pixel);
        squares += at * at.transpose();
        products += at * point.inverse_m;
    }
    return squares.ldlt().solve(products).transpose();
}

/// The planes of all windows whose depth is plane.
std::vector<Proposal> proposed(std::span<const DepthMapView> views) {
    std::vector<Proposal> proposals;
    std::vector<Point> window, on_plane;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const DepthMapView& view = views[i];
        const DepthImage& depth_m = *view.depth_m;
        for (int y = window_reach_px; y + window_reach_px < depth_m.rows; y += window_step_px)
            for (int x = window_reach_px; x + window_reach_px < depth_m.cols; x += window_step_px) {
                window.clear();
                for (int v = y - window_reach_px; v <= y + window_reach_px; ++v)
                    for (int u = x - window_reach_px; u <= x + window_reach_px; ++u)
                        if (const float z = depth_m(v, u); z > 0)
                            window.push_back({i, Eigen::Vector2d(u, v), 1.0 / z});
                const auto wanted = static_cast<std::size_t>(
                    plane_share * (2 * window_reach_px + 1) * (2 * window_reach_px + 1));
                if (window.size() < wanted) continue;
                Eigen::RowVector3d depth = fitted(window);
                on_plane.clear();
                for (const Point& point : window)
                    if (std::abs(depth.dot(homogeneous(point.pixel)) - point.inverse_m) <
                        view.tolerance_per_m)
                        on_plane.push_back(point);
                if (on_plane.size() < wanted) continue;
                depth = fitted(on_plane);
                const Eigen::Vector2d middle(x, y);
                proposals.push_back(
                    {plane_of(depth, view), {i, middle, depth.dot(homogeneous(middle))}});
            }
    }
    return proposals;
}

/// A plane's inverse depth in all views.
std::vector<Eigen::RowVector3d> in_views(const ScenePlane& plane,
                                         std::span<const DepthMapView> views) {
    std::vector<Eigen::RowVector3d> depths;
    depths.reserve(views.size());
    for (const DepthMapView& view : views)
        depths.push_back(inverse_depth_of(plane, view.K, view.world_from_camera));
    return depths;
}

bool is_on(std::span<const Eigen::RowVector3d> plane, std::span<const DepthMapView> views,
           const Point& point) {
    return std::abs(plane[point.view].dot(homogeneous(point.pixel)) - point.inverse_m) <
           views[point.view].tolerance_per_m;
}

/// The plane that fits its own points best, in inverse depth.
ScenePlane refitted(const ScenePlane& plane, std::span<const DepthMapView> views,
                    std::span<const Point> points) {
    const std::vector<Eigen::RowVector3d> depths = in_views(plane, views);
    // Planes before the first view: m . (X - origin) = 1.
    const Eigen::Vector3d origin = views.front().world_from_camera.translation();
    const double offset = -(plane.head<3>().dot(origin) + plane.w());
    if (std::abs(offset) < 1e-6) return plane;
    const Eigen::Vector3d m = plane.head<3>() / offset;
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d products = Eigen::Vector3d::Zero();
    std::vector<Eigen::Matrix3d> ray_of_pixel;
    for (const DepthMapView& view : views)
        ray_of_pixel.emplace_back(view.world_from_camera.linear() * view.K.inverse());
    for (const Point& point : points) {
        if (!is_on(depths, views, point)) continue;
        const DepthMapView& view = views[point.view];
        const Eigen::Vector3d ray = ray_of_pixel[point.view] * homogeneous(point.pixel);
        const double z_m = 1 / point.inverse_m;
        const Eigen::Vector3d at = view.world_from_camera.translation() + z_m * ray - origin;
        // How much m . at changes if the inverse depth is off by the tolerance.
        const double change = m.dot(ray) * z_m * z_m * view.tolerance_per_m;
        const double weight = 1 / std::max(change * change, 1e-12);
        squares += weight * at * at.transpose();
        products += weight * at;
    }
    const Eigen::Vector3d better = squares.ldlt().solve(products);
    if (!better.allFinite() || better.norm() == 0) return plane;
    ScenePlane result;
    result << better, -1 - better.dot(origin);
    return result / better.norm();
}

std::vector<Point> points_of(std::span<const DepthMapView> views) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const DepthImage& depth_m = *views[i].depth_m;
        for (int y = 0; y < depth_m.rows; y += point_step_px)
            for (int x = 0; x < depth_m.cols; x += point_step_px)
                if (const float z = depth_m(y, x); z > 0)
                    points.push_back({i, Eigen::Vector2d(x, y), 1.0 / z});
    }
    return points;
}

}  // namespace

Eigen::RowVector3d inverse_depth_of(const ScenePlane& plane, const Eigen::Matrix3d& K,
                                    const Pose& world_from_camera) {
    const double distance = plane.head<3>().dot(world_from_camera.translation()) + plane.w();
    return plane.head<3>().transpose() * world_from_camera.linear() * K.inverse() / -distance;
}

std::vector<ScenePlane> planes_of(std::span<const DepthMapView> views, std::size_t max_planes,
                                  std::span<const ScenePlane> expected) {
    std::vector<Proposal> proposals = proposed(views);
    std::vector<ScenePlane> planes;
    std::vector<Point> points = points_of(views);
    const auto choose = [&](const ScenePlane& plane) {
        planes.push_back(plane);
        const std::vector<Eigen::RowVector3d> depths = in_views(plane, views);
        std::erase_if(points, [&](const Point& point) { return is_on(depths, views, point); });
        std::erase_if(proposals,
                      [&](const Proposal& one) { return is_on(depths, views, one.middle); });
    };
    const auto fewest = static_cast<std::ptrdiff_t>(min_share * static_cast<double>(points.size()));
    const auto count = [&](const ScenePlane& plane) {
        const std::vector<Eigen::RowVector3d> depths = in_views(plane, views);
        return std::count_if(points.begin(), points.end(),
                             [&](const Point& point) { return is_on(depths, views, point); });
    };
    const auto all = static_cast<double>(points.size());
    for (const ScenePlane& plane : expected)
        if (static_cast<double>(count(plane)) > expected_share * all) choose(plane);
    // Always in the same order.
    std::shuffle(proposals.begin(), proposals.end(), std::mt19937());
    while (planes.size() < max_planes) {
        std::ptrdiff_t most = 0;
        ScenePlane best = ScenePlane::Zero();
        for (std::size_t i = 0; i < std::min(max_compared, proposals.size()); ++i) {
            const std::ptrdiff_t on_plane = count(proposals[i].plane);
            if (on_plane <= most) continue;
            most = on_plane;
            best = proposals[i].plane;
        }
        if (most == 0 || most < fewest) break;
        for (int fit = 0; fit < fits; ++fit) best = refitted(best, views, points);
        choose(best);
    }
    return planes;
}

}  // namespace vantage
