#include "host_app/gallery/camera_plane.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace vantage {
namespace {

/// Largest angle of a camera to the mean line of sight.
constexpr double max_angle_rad = 70 * std::numbers::pi / 180;
/// Largest extent of the cameras along the line of sight, relative to the array's width.
constexpr double max_depth_share = 0.35;
/// Height relative to the width below which an array counts as an uneven row.
constexpr double min_height_share = 0.05;
/// Distance relative to the mean column distance below which two cameras share a column.
constexpr double same_column = 0.3;

/// Returns the sorted centres of the columns (or rows) that places along one direction form.
std::vector<double> columns_of(std::vector<double> places, std::size_t cameras) {
    std::sort(places.begin(), places.end());
    const double extent = places.back() - places.front();
    const double apart =
        same_column * extent / std::max<double>(1, std::ceil(std::sqrt(cameras)) - 1);
    std::vector<double> middles;
    for (std::size_t i = 0; i < places.size();) {
        std::size_t end = i + 1;
        while (end < places.size() && places[end] - places[end - 1] < apart) ++end;
        double sum = 0;
        for (std::size_t k = i; k < end; ++k) sum += places[k];
        middles.push_back(sum / static_cast<double>(end - i));
        i = end;
    }
    return middles;
}

/// Returns the distances to the columns before and after the one that `place` is in.
std::pair<double, double> reach(const std::vector<double>& columns, double place) {
    const auto nearest = std::min_element(columns.begin(), columns.end(), [&](double a, double b) {
        return std::abs(a - place) < std::abs(b - place);
    });
    const double before = nearest == columns.begin() ? 0 : place - *(nearest - 1);
    const double after = nearest + 1 == columns.end() ? 0 : *(nearest + 1) - place;
    // A camera at the border reaches as far outward as inward.
    return {before > 0 ? before : after, after > 0 ? after : before};
}

}  // namespace

CameraPlane camera_plane(const std::vector<Pose>& poses) {
    CameraPlane plane;
    if (poses.size() < 2) {
        plane.refusal = fmt::format(
            "a light field needs at least two cameras in a row or a grid, not {}: give a view set "
            "with more views",
            poses.size());
        return plane;
    }
    Eigen::Vector3d middle = Eigen::Vector3d::Zero(), ahead = Eigen::Vector3d::Zero(),
                    down = Eigen::Vector3d::Zero();
    for (const Pose& pose : poses) {
        middle += pose.translation() / static_cast<double>(poses.size());
        ahead += pose.linear().col(2);
        down += pose.linear().col(1);
    }
    const auto refuse = [&](const std::string& what) {
        plane.refusal = fmt::format(
            "a light field's cameras must lie in one plane and face the same way; of these {} {}: "
            "choose views of a row or a grid",
            poses.size(), what);
        return plane;
    };
    if (ahead.norm() < 1e-6) return refuse("some face opposite directions");
    ahead.normalize();
    for (const Pose& pose : poses)
        if (const double angle = std::acos(std::clamp(pose.linear().col(2).dot(ahead), -1.0, 1.0));
            angle > max_angle_rad)
            return refuse(fmt::format(
                "one faces {:.0f} degrees away from their mean direction, more than {:.0f}",
                angle * 180 / std::numbers::pi, max_angle_rad * 180 / std::numbers::pi));
    // Columns along the cameras' own right, however the array is stretched.
    Eigen::Vector3d across = down.cross(ahead).normalized();
    plane.world_from_plane.linear() << across, ahead.cross(across), ahead;
    plane.world_from_plane.translation() = middle;
    const Pose plane_from_world = plane.world_from_plane.inverse();
    std::vector<double> x_m, y_m, z_m;
    for (const Pose& pose : poses) {
        const Eigen::Vector3d at = plane_from_world * pose.translation();
        plane.cameras.push_back({at.head<2>(), Eigen::Vector4d::Zero()});
        x_m.push_back(at.x());
        y_m.push_back(at.y());
        z_m.push_back(at.z());
    }
    const auto extent = [](const std::vector<double>& places) {
        const auto [least, most] = std::minmax_element(places.begin(), places.end());
        return *most - *least;
    };
    const double width = std::max(extent(x_m), extent(y_m));
    if (width < 1e-9) return refuse("all are at one place");
    if (extent(z_m) > max_depth_share * width)
        return refuse(fmt::format("some are {:.2f} m in front of others, with a width of {:.2f} m",
                                  extent(z_m), width));
    const bool has_width = extent(x_m) > min_height_share * width,
               has_height = extent(y_m) > min_height_share * width;
    plane.is_row = !(has_width && has_height);
    // In a row every camera is a column of its own.
    const std::size_t of = plane.is_row ? poses.size() * poses.size() : poses.size();
    const std::vector<double> columns = columns_of(x_m, of), rows = columns_of(y_m, of);
    for (PlacedCamera& camera : plane.cameras) {
        if (has_width)
            std::tie(camera.reach_m[0], camera.reach_m[1]) = reach(columns, camera.at_m.x());
        if (has_height)
            std::tie(camera.reach_m[2], camera.reach_m[3]) = reach(rows, camera.at_m.y());
    }
    return plane;
}

}  // namespace vantage
