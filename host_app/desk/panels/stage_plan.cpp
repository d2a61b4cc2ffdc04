#include <algorithm>
#include <cmath>

#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

/// The map from metres on the floor to pixels: x to the right, z downwards.
class PlanMap {
  public:
    PlanMap(const DeskRect& rect, const Eigen::Vector2d& least_m, const Eigen::Vector2d& most_m)
        : right_(rect.right()) {
        const Eigen::Vector2d span = (most_m - least_m).cwiseMax(1.0);
        // The scale has steps, so that the plan stands still while the camera flies.
        constexpr double step = 1.12;
        const double fits = std::min(rect.width / span.x(), rect.height / span.y());
        px_per_m_ = static_cast<float>(std::pow(step, std::floor(std::log(fits) / std::log(step))));
        const Eigen::Vector2d middle = 0.5 * (least_m + most_m);
        left_ = rect.left + 0.5f * rect.width - px_per_m_ * static_cast<float>(middle.x());
        top_ = rect.top + 0.5f * rect.height - px_per_m_ * static_cast<float>(middle.y());
    }
    ImVec2 at(double x_m, double z_m) const {
        return {left_ + px_per_m_ * static_cast<float>(x_m),
                top_ + px_per_m_ * static_cast<float>(z_m)};
    }
    ImVec2 at(const Eigen::Vector3d& point_m) const { return at(point_m.x(), point_m.z()); }
    float px_per_m() const { return px_per_m_; }
    float right() const { return right_; }  ///< limit for names

  private:
    float px_per_m_ = 1, left_ = 0, top_ = 0, right_;
};

/// A camera from above: position, direction and width of its field.
struct SeenCamera {
    Eigen::Vector3d eye_m;
    Eigen::Vector3d forward;
    double half_width;

    /// Returns a point of the field's left (-1) or right (1) edge at a depth.
    Eigen::Vector3d edge_m(double side, double depth_m) const {
        const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitY());
        const double length = right.norm();
        // The field of a camera that looks straight down has no width here.
        return eye_m +
               depth_m * (forward + (length > 1e-3 ? side * half_width / length : 0) * right);
    }
};

PlanMap map_of(const DeskRect& rect, const DeskPlan& plan, const DeskState& state) {
    Eigen::Vector2d least(1e9, 1e9), most(-1e9, -1e9);
    const auto take_in = [&](const Eigen::Vector3d& point_m, double margin_m) {
        const Eigen::Vector2d at(point_m.x(), point_m.z());
        least = least.cwiseMin((at.array() - margin_m).matrix());
        most = most.cwiseMax((at.array() + margin_m).matrix());
    };
    take_in(plan.extent.centre_m, plan.extent.radius_m);
    for (const DeskPlan::Rig& rig : plan.rigs) take_in(rig.eye_m, 0.6);
    const auto take_in_view = [&](const OrbitView& view) {
        take_in(view.eye_m(), 0.6);
        take_in(view.pivot_m, 0.3);
    };
    take_in_view(state.view);
    if (state.preview) take_in_view(state.preview->view);
    return {rect, least, most};
}

void draw_corridor(const Pen& pen, const PlanMap& map, const DeskPlan& plan) {
    for (const DeskPlan::Field& field : plan.corridor) {
        if (field.place == CorridorPlace::beyond) continue;
        const ImVec4& colour =
            field.place == CorridorPlace::inside ? palette::corridor : palette::corridor_edge;
        const auto corner = [&](double side, double distance_m) {
            const double azimuth = field.azimuth_rad + side * 0.5 * field.width_rad;
            return map.at(plan.corridor_pivot_m.x() + distance_m * std::sin(azimuth),
                          plan.corridor_pivot_m.z() + distance_m * std::cos(azimuth));
        };
        pen.list().AddQuadFilled(corner(-1, field.from_m), corner(1, field.from_m),
                                 corner(1, field.to_m), corner(-1, field.to_m),
                                 ImGui::GetColorU32(colour));
    }
}

void draw_field(const Pen& pen, const PlanMap& map, const SeenCamera& camera, double depth_m,
                const ImVec4& colour, float filled) {
    const ImVec2 eye = map.at(camera.eye_m), left = map.at(camera.edge_m(-1, depth_m)),
                 right = map.at(camera.edge_m(1, depth_m));
    ImVec4 faint = colour;
    faint.w *= filled;
    pen.list().AddTriangleFilled(eye, left, right, ImGui::GetColorU32(faint));
    const ImU32 line = ImGui::GetColorU32(colour);
    pen.list().AddLine(eye, left, line);
    pen.list().AddLine(eye, right, line);
}

/// Draws a camera as a small arrow.
void draw_body(const Pen& pen, const PlanMap& map, const SeenCamera& camera, const ImVec4& colour) {
    const double size_m = 0.45 * pen.em() / map.px_per_m();
    Eigen::Vector3d ahead = camera.forward;
    ahead.y() = 0;
    if (ahead.norm() < 1e-3) ahead = -Eigen::Vector3d::UnitZ();
    ahead.normalize();
    const Eigen::Vector3d aside = ahead.cross(Eigen::Vector3d::UnitY());
    pen.list().AddTriangleFilled(map.at(camera.eye_m + 1.3 * size_m * ahead),
                                 map.at(camera.eye_m - size_m * (ahead + aside)),
                                 map.at(camera.eye_m - size_m * (ahead - aside)),
                                 ImGui::GetColorU32(colour));
}

void draw_rigs(const Pen& pen, const PlanMap& map, const DeskPlan& plan) {
    for (const DeskPlan::Rig& rig : plan.rigs) {
        const SeenCamera camera{rig.eye_m, rig.forward, rig.half_width};
        const double depth_m = (plan.extent.centre_m - rig.eye_m).norm() + plan.extent.radius_m;
        if (!rig.is_away) draw_field(pen, map, camera, depth_m, palette::field, 0.35f);
    }
    for (const DeskPlan::Rig& rig : plan.rigs) {
        const ImVec4& colour = rig.is_away ? palette::bad : palette::good;
        draw_body(pen, map, {rig.eye_m, rig.forward, rig.half_width}, colour);
        // Behind the rig, where neighbours with the same direction leave room.
        const Eigen::Vector3d behind_m =
            rig.eye_m - 1.5 * pen.em() / map.px_per_m() *
                            Eigen::Vector3d(rig.forward.x(), 0, rig.forward.z()).normalized();
        const ImVec2 at = map.at(behind_m);
        pen.text(at.x - 0.5f * pen.width_of(rig.name), at.y - 0.5f * pen.em(), palette::dim,
                 rig.name);
    }
}

void draw_path(const Pen& pen, const PlanMap& map, const DeskPlan& plan) {
    for (std::size_t i = 1; i < plan.move_m.size(); i += 2)
        pen.list().AddLine(map.at(plan.move_m[i - 1]), map.at(plan.move_m[i]),
                           ImGui::GetColorU32(palette::dim));
    for (const Eigen::Vector3d& keyframe_m : plan.keyframes_m)
        pen.list().AddCircleFilled(map.at(keyframe_m), 0.22f * pen.em(),
                                   ImGui::GetColorU32(palette::dim));
    for (std::size_t i = 1; i < plan.path_m.size(); ++i) {
        ImVec4 colour = palette::accent;
        colour.w = static_cast<float>(i) / static_cast<float>(plan.path_m.size());
        pen.list().AddLine(map.at(plan.path_m[i - 1]), map.at(plan.path_m[i]),
                           ImGui::GetColorU32(colour), 0.12f * pen.em());
    }
}

void draw_camera(const Pen& pen, const PlanMap& map, const DeskPlan& plan, const OrbitView& view,
                 const ImVec4& field, std::string_view name) {
    const Pose pose = view.world_from_camera();
    const SeenCamera camera{pose.translation(), pose.linear().col(2),
                            std::tan(0.5 * view.field_of_view_rad)};
    draw_field(pen, map, camera, view.distance_m + plan.extent.radius_m, field, 0.16f);
    const ImVec2 pivot = map.at(view.pivot_m);
    const float arm = 0.45f * pen.em(), thick = std::max(1.0f, 0.1f * pen.em());
    pen.fill({pivot.x - arm, pivot.y - 0.5f * thick, 2 * arm, thick}, palette::text);
    pen.fill({pivot.x - 0.5f * thick, pivot.y - arm, thick, 2 * arm}, palette::text);
    draw_body(pen, map, camera, palette::text);
    const ImVec2 eye = map.at(camera.eye_m);
    const float x = std::min(eye.x + 0.7f * pen.em(), map.right() - pen.width_of(name, true));
    pen.text(x, eye.y - 1.6f * pen.em(), field, name, true);
}

void draw_scale(const Pen& pen, const DeskRect& rect, const PlanMap& map) {
    const float x = rect.left + 0.6f * pen.em(), y = rect.bottom() - 0.6f * pen.em();
    pen.fill({x, y, map.px_per_m(), std::max(1.0f, 0.1f * pen.em())}, palette::dim);
    pen.text(x, y - 1.2f * pen.em(), palette::dim, "1 m");
}

}  // namespace

void draw_unknown_stage(const Pen& pen, const DeskRect& rect) {
    pen.text(rect.left + 0.6f * pen.em(), rect.top + 0.5f * pen.em(), palette::dim,
             "waiting for the rigs' positions");
}

void draw_stage_plan(const Pen& pen, const DeskRect& rect, const DeskState& state) {
    if (rect.is_empty()) return;
    const Clipping clipping(pen, rect);
    pen.fill(rect, palette::panel);
    if (!state.plan) return draw_unknown_stage(pen, rect);
    const PlanMap map = map_of(rect.shrunk(1.3f * pen.em()), *state.plan, state);
    draw_corridor(pen, map, *state.plan);
    pen.list().AddCircle(map.at(state.plan->extent.centre_m),
                         map.px_per_m() * static_cast<float>(state.plan->extent.radius_m),
                         ImGui::GetColorU32(palette::line));
    draw_rigs(pen, map, *state.plan);
    draw_path(pen, map, *state.plan);
    draw_camera(pen, map, *state.plan, state.view, palette::accent,
                state.preview ? "programme" : "");
    if (state.preview)
        draw_camera(pen, map, *state.plan, state.preview->view, palette::good, "preview");
    draw_scale(pen, rect, map);
}

}  // namespace vantage
