#include "host_app/desk/panels/stage_outside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

constexpr double near_plane_m = 0.1;
constexpr double outside_field_of_view_rad = 0.8;  ///< along the shorter side

double reach_m(const DeskPlan& plan) {
    double reach = plan.extent.radius_m;
    for (const DeskPlan::Rig& rig : plan.rigs)
        reach = std::max(reach, (rig.eye_m - plan.extent.centre_m).norm());
    return reach;
}

/// A camera's position, axes, and half of its picture's width and height at a depth of 1.
struct Frustum {
    Eigen::Vector3d eye_m, right, up, forward;
    double half_width, half_height;

    /// Returns a corner of the picture (-1 or 1 along either axis) at a depth.
    Eigen::Vector3d corner_m(double aside, double above, double depth_m) const {
        return eye_m + depth_m * (forward + aside * half_width * right + above * half_height * up);
    }
};

Frustum frustum_of(const DeskPlan::Rig& rig) {
    Eigen::Vector3d right = rig.forward.cross(Eigen::Vector3d::UnitY());
    // For a camera that looks straight down any direction will do.
    right = right.norm() > 1e-3 ? Eigen::Vector3d(right.normalized()) : Eigen::Vector3d::UnitX();
    return {rig.eye_m,   right,          right.cross(rig.forward),
            rig.forward, rig.half_width, rig.half_height};
}

Frustum frustum_of(const OrbitView& view, float aspect) {
    const Pose pose = view.world_from_camera();
    const double half_width = std::tan(0.5 * view.field_of_view_rad);
    return {pose.translation(),   pose.linear().col(0), -pose.linear().col(1),
            pose.linear().col(2), half_width,           half_width * aspect};
}

/// Draws lines and text at positions on the stage.
class OutsidePen {
  public:
    OutsidePen(const Pen& pen, const OutsideMap& map) : pen_(pen), map_(map) {}

    void line(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, const ImVec4& colour,
              float thickness = 1) const {
        if (const auto seen = map_.line(from_m, to_m))
            pen_.list().AddLine({seen->from.x, seen->from.y}, {seen->to.x, seen->to.y},
                                ImGui::GetColorU32(colour), thickness);
    }
    void words(const Eigen::Vector3d& at_m, const ImVec4& colour, std::string_view words) const {
        if (const auto seen = map_.at(at_m))
            pen_.text(seen->x + 0.4f * pen_.em(), seen->y - 0.5f * pen_.em(), colour, words);
    }
    void dot(const Eigen::Vector3d& at_m, const ImVec4& colour, float radius) const {
        if (const auto seen = map_.at(at_m))
            pen_.list().AddCircleFilled({seen->x, seen->y}, radius, ImGui::GetColorU32(colour));
    }
    void frustum(const Frustum& camera, double depth_m, const ImVec4& colour,
                 float thickness) const {
        constexpr std::array<std::array<double, 2>, 4> corners{
            {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto& [aside, above] = corners[i];
            const auto& [next_aside, next_above] = corners[(i + 1) % corners.size()];
            const Eigen::Vector3d corner_m = camera.corner_m(aside, above, depth_m);
            line(camera.eye_m, corner_m, colour, thickness);
            line(corner_m, camera.corner_m(next_aside, next_above, depth_m), colour, thickness);
        }
    }
    const Pen& pen() const { return pen_; }

  private:
    const Pen& pen_;
    const OutsideMap& map_;
};

/// Draws the points from the farthest to the nearest, so that nearer ones cover them.
void draw_points(const Pen& pen, const OutsideMap& map,
                 const std::vector<DeskPlan::Point>& points) {
    struct Seen {
        OutsideMap::Place place;
        ImU32 colour;
    };
    std::vector<Seen> seen;
    seen.reserve(points.size());
    for (const DeskPlan::Point& point : points)
        if (const auto place = map.at(point.at_m.cast<double>()))
            seen.push_back({*place, IM_COL32(point.rgb[0], point.rgb[1], point.rgb[2], 255)});
    std::sort(seen.begin(), seen.end(),
              [](const Seen& a, const Seen& b) { return a.place.depth_m > b.place.depth_m; });
    constexpr double point_m = 0.07;
    for (const Seen& one : seen) {
        const auto half = static_cast<float>(
            std::clamp(0.5 * point_m * map.px_per_m(one.place.depth_m), 0.75, 6.0));
        pen.list().AddRectFilled({one.place.x - half, one.place.y - half},
                                 {one.place.x + half, one.place.y + half}, one.colour);
    }
}

void draw_floor(const OutsidePen& pen, const StageExtent& extent) {
    constexpr int parts = 48;
    const auto at = [&](int part) {
        const double angle = 2 * std::numbers::pi * part / parts;
        return Eigen::Vector3d(extent.centre_m.x() + extent.radius_m * std::sin(angle), 0,
                               extent.centre_m.z() + extent.radius_m * std::cos(angle));
    };
    for (int part = 0; part < parts; ++part) pen.line(at(part), at(part + 1), palette::tick);
}

/// Draws the corridor at the camera's elevation: covered fields, and its edge in the warning tint.
void draw_corridor(const OutsidePen& pen, const OutsideMap& map, const DeskPlan& plan) {
    const double rise = std::sin(plan.corridor_elevation_rad);
    const double run = std::cos(plan.corridor_elevation_rad);
    for (const DeskPlan::Field& field : plan.corridor) {
        if (field.place == CorridorPlace::beyond) continue;
        ImVec4 colour =
            field.place == CorridorPlace::inside ? palette::corridor : palette::corridor_edge;
        const auto corner = [&](double side, double distance_m) {
            const double azimuth = field.azimuth_rad + side * 0.5 * field.width_rad;
            return map.at(plan.corridor_pivot_m +
                          distance_m * Eigen::Vector3d(run * std::sin(azimuth), rise,
                                                       run * std::cos(azimuth)));
        };
        const std::array corners{corner(-1, field.from_m), corner(1, field.from_m),
                                 corner(1, field.to_m), corner(-1, field.to_m)};
        if (!std::all_of(corners.begin(), corners.end(),
                         [](const auto& c) { return c.has_value(); }))
            continue;
        const auto at = [&](std::size_t i) { return ImVec2(corners[i]->x, corners[i]->y); };
        pen.pen().list().AddQuadFilled(at(0), at(1), at(2), at(3), ImGui::GetColorU32(colour));
    }
}

void draw_rigs(const OutsidePen& pen, const DeskPlan& plan) {
    constexpr double body_m = 0.35;
    for (const DeskPlan::Rig& rig : plan.rigs) {
        const Frustum frustum = frustum_of(rig);
        if (!rig.is_away)
            pen.frustum(frustum, (plan.extent.centre_m - rig.eye_m).norm(), palette::field, 1);
        pen.frustum(frustum, body_m, rig.is_away ? palette::bad : palette::good,
                    std::max(1.0f, 0.12f * pen.pen().em()));
        pen.words(rig.eye_m, palette::dim, rig.name);
    }
}

void draw_path(const OutsidePen& pen, const DeskPlan& plan) {
    for (std::size_t i = 1; i < plan.move_m.size(); i += 2)
        pen.line(plan.move_m[i - 1], plan.move_m[i], palette::dim);
    for (const Eigen::Vector3d& keyframe_m : plan.keyframes_m)
        pen.dot(keyframe_m, palette::dim, 0.22f * pen.pen().em());
    for (std::size_t i = 1; i < plan.path_m.size(); ++i) {
        ImVec4 colour = palette::accent;
        colour.w = static_cast<float>(i) / static_cast<float>(plan.path_m.size());
        pen.line(plan.path_m[i - 1], plan.path_m[i], colour, 0.12f * pen.pen().em());
    }
}

void draw_camera(const OutsidePen& pen, const OrbitView& view, float aspect, const ImVec4& colour,
                 std::string_view name) {
    constexpr double body_m = 0.5, arm_m = 0.15;
    const float thick = std::max(1.0f, 0.16f * pen.pen().em());
    const Frustum frustum = frustum_of(view, aspect);
    ImVec4 faint = colour;
    faint.w = 0.4f;
    pen.frustum(frustum, view.distance_m, faint, 1);
    pen.frustum(frustum, body_m, colour, thick);
    pen.words(view.eye_m(), colour, name);
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d arm = arm_m * Eigen::Vector3d::Unit(axis);
        pen.line(view.pivot_m - arm, view.pivot_m + arm, palette::text, thick);
    }
}

}  // namespace

OutsideMap::OutsideMap(const DeskRect& rect, const DeskPlan& plan, const OutsideEye& eye)
    : focal_px_(0.5 * std::min(rect.width, rect.height) /
                std::tan(0.5 * outside_field_of_view_rad)),
      middle_x_(rect.left + 0.5f * rect.width),
      middle_y_(rect.top + 0.5f * rect.height) {
    OrbitView view;
    view.pivot_m = plan.extent.centre_m;
    view.azimuth_rad = eye.azimuth_rad;
    view.elevation_rad = eye.elevation_rad;
    view.distance_m =
        reach_m(plan) / std::sin(0.5 * outside_field_of_view_rad) * std::exp(-eye.nearness);
    camera_from_world_ = view.world_from_camera().inverse();
}

OutsideMap::Place OutsideMap::place_of(const Eigen::Vector3d& in_camera) const {
    const double scale = focal_px_ / in_camera.z();
    return {middle_x_ + static_cast<float>(scale * in_camera.x()),
            middle_y_ + static_cast<float>(scale * in_camera.y()), in_camera.z()};
}

std::optional<OutsideMap::Place> OutsideMap::at(const Eigen::Vector3d& point_m) const {
    const Eigen::Vector3d in_camera = camera_from_world_ * point_m;
    if (in_camera.z() < near_plane_m) return std::nullopt;
    return place_of(in_camera);
}

std::optional<OutsideMap::Line> OutsideMap::line(const Eigen::Vector3d& from_m,
                                                 const Eigen::Vector3d& to_m) const {
    Eigen::Vector3d from = camera_from_world_ * from_m, to = camera_from_world_ * to_m;
    if (from.z() < near_plane_m && to.z() < near_plane_m) return std::nullopt;
    const auto cut = [](Eigen::Vector3d& behind, const Eigen::Vector3d& before) {
        behind += (near_plane_m - behind.z()) / (before.z() - behind.z()) * (before - behind);
    };
    if (from.z() < near_plane_m) cut(from, to);
    if (to.z() < near_plane_m) cut(to, from);
    return Line{place_of(from), place_of(to)};
}

void draw_stage_outside(const Pen& pen, const DeskRect& rect, const DeskState& state,
                        const OutsideEye& eye) {
    if (rect.is_empty()) return;
    const Clipping clipping(pen, rect);
    pen.fill(rect, palette::panel);
    if (!state.plan) return draw_unknown_stage(pen, rect);
    const DeskPlan& plan = *state.plan;
    const OutsideMap map(rect, plan, eye);
    const OutsidePen outside(pen, map);
    draw_floor(outside, plan.extent);
    draw_corridor(outside, map, plan);
    draw_points(pen, map, plan.points);
    draw_rigs(outside, plan);
    draw_path(outside, plan);
    const float aspect = aspect_of(state.picture);
    draw_camera(outside, state.view, aspect, palette::accent, state.preview ? "programme" : "");
    if (state.preview) draw_camera(outside, state.preview->view, aspect, palette::good, "preview");
}

}  // namespace vantage
