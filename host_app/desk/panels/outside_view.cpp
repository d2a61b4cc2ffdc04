#include "host_app/desk/panels/outside_view.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr double nearest_m = 0.1;
constexpr double field_of_view_rad = 0.8;  ///< of the lesser of width and height

double reach_m(const DeskPlan& plan) {
    double reach = plan.extent.radius_m;
    for (const DeskPlan::Rig& rig : plan.rigs)
        reach = std::max(reach, (rig.eye_m - plan.extent.centre_m).norm());
    return reach;
}

}  // namespace

OutsideMap::OutsideMap(const DeskRect& rect, const DeskPlan& plan, const OutsideEye& eye)
    : focal_px_(0.5 * std::min(rect.width, rect.height) / std::tan(0.5 * field_of_view_rad)),
      middle_x_(rect.left + 0.5f * rect.width),
      middle_y_(rect.top + 0.5f * rect.height) {
    OrbitView view;
    view.pivot_m = plan.extent.centre_m;
    view.azimuth_rad = eye.azimuth_rad;
    view.elevation_rad = eye.elevation_rad;
    view.distance_m = reach_m(plan) / std::sin(0.5 * field_of_view_rad) * std::exp(-eye.nearness);
    camera_from_world_ = view.world_from_camera().inverse();
}

OutsideMap::Place OutsideMap::place_of(const Eigen::Vector3d& in_camera) const {
    const double scale = focal_px_ / in_camera.z();
    return {middle_x_ + static_cast<float>(scale * in_camera.x()),
            middle_y_ + static_cast<float>(scale * in_camera.y()), in_camera.z()};
}

std::optional<OutsideMap::Place> OutsideMap::at(const Eigen::Vector3d& point_m) const {
    const Eigen::Vector3d in_camera = camera_from_world_ * point_m;
    if (in_camera.z() < nearest_m) return std::nullopt;
    return place_of(in_camera);
}

std::optional<OutsideMap::Line> OutsideMap::line(const Eigen::Vector3d& from_m,
                                                 const Eigen::Vector3d& to_m) const {
    Eigen::Vector3d from = camera_from_world_ * from_m, to = camera_from_world_ * to_m;
    if (from.z() < nearest_m && to.z() < nearest_m) return std::nullopt;
    const auto cut = [](Eigen::Vector3d& behind, const Eigen::Vector3d& before) {
        behind += (nearest_m - behind.z()) / (before.z() - behind.z()) * (before - behind);
    };
    if (from.z() < nearest_m) cut(from, to);
    if (to.z() < nearest_m) cut(to, from);
    return Line{place_of(from), place_of(to)};
}

}  // namespace vantage
