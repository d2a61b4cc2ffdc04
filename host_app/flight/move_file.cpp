#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/config/toml_reader.h"
#include "host_app/flight/move.h"

namespace vantage {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;
constexpr std::size_t max_keyframes = 1000;

Easing easing_of(const std::string& name) {
    if (name == "linear") return Easing::linear;
    if (name == "ease") return Easing::ease;
    if (name == "cut") return Easing::cut;
    return Easing::smooth;
}

void read_degrees(TomlTable& table, std::string_view key, double& value_rad, Range<double> range) {
    double degrees = 0;
    table.read(key, degrees, range);
    if (table.has(key)) value_rad = degrees * rad_per_deg;
}

void read_eye(TomlTable& table, OrbitView& view) {
    for (const char* orbit_key : {"pivot_m", "azimuth_deg", "elevation_deg", "distance_m"})
        if (table.has(orbit_key))
            table.refuse(orbit_key,
                         "does not go with eye_m and target_m; a keyframe says either where the "
                         "camera is or how it orbits");
    Eigen::Vector3d eye = Eigen::Vector3d::Zero(), target = view.pivot_m;
    table.read("eye_m", std::span<double>(eye.data(), 3), {-100, 100});
    table.read("target_m", std::span<double>(target.data(), 3), {-30, 30});
    table.require("eye_m");
    if (!table.has("eye_m")) return;
    if ((eye - target).norm() < 1e-6) table.refuse("eye_m", "must not be the point it looks at");
    view = view_from_eye(eye, target, view.field_of_view_rad, view.azimuth_rad);
}

/// `view` comes with the values of the keyframe before.
MoveKeyframe read_keyframe(TomlTable& table, OrbitView view, const FlightLimits& limits) {
    MoveKeyframe keyframe;
    table.read("time_s", keyframe.time_s, {0, 24 * 3600});
    table.require("time_s");
    read_degrees(table, "field_of_view_deg", view.field_of_view_rad, {5, 110});
    if (table.has("eye_m") || table.has("target_m")) {
        read_eye(table, view);
    } else {
        table.read("pivot_m", std::span<double>(view.pivot_m.data(), 3),
                   {-limits.max_pivot_offset_m, limits.max_pivot_offset_m});
        read_degrees(table, "azimuth_deg", view.azimuth_rad, {-36000, 36000});
        read_degrees(table, "elevation_deg", view.elevation_rad, {-85, 85});
        table.read("distance_m", view.distance_m, {limits.min_distance_m, limits.max_distance_m});
    }
    const OrbitView allowed = constrained(view, limits);
    if ((allowed.eye_m() - view.eye_m()).norm() > 1e-9 ||
        (allowed.pivot_m - view.pivot_m).norm() > 1e-9) {
        const Eigen::Vector3d eye = view.eye_m();
        table.refuse("time_s",
                     fmt::format("names a keyframe with the camera at ({:.2f}, {:.2f}, {:.2f}) m, "
                                 "{:.2f} m from what it looks at, which is outside the flight's "
                                 "limits: {} m above the floor at least, {} to {} m away, at most "
                                 "{:.0f} degrees up or down",
                                 eye.x(), eye.y(), eye.z(), view.distance_m,
                                 limits.min_eye_height_m, limits.min_distance_m,
                                 limits.max_distance_m, limits.max_elevation_rad / rad_per_deg));
    }
    keyframe.view = view;
    std::string easing = "smooth";
    table.read_choice("easing", easing, {"smooth", "linear", "ease", "cut"});
    keyframe.easing = easing_of(easing);
    return keyframe;
}

/// The same picture, whole turns aside.
bool is_same_shot(const OrbitView& a, const OrbitView& b) {
    return (a.pivot_m - b.pivot_m).norm() < 1e-6 &&
           std::abs(nearest_turn(a.azimuth_rad, b.azimuth_rad) - b.azimuth_rad) < 1e-6 &&
           std::abs(a.elevation_rad - b.elevation_rad) < 1e-6 &&
           std::abs(a.distance_m - b.distance_m) < 1e-6 &&
           std::abs(a.field_of_view_rad - b.field_of_view_rad) < 1e-6;
}

}  // namespace

Move Move::load(const std::filesystem::path& path) {
    const FlightLimits limits;
    std::vector<MoveKeyframe> keyframes;
    bool loop = false;
    read_toml_file(path, 1, [&](TomlTable& top) {
        top.read("loop", loop);
        top.read_tables("keyframe", [&](TomlTable& table) {
            const OrbitView before = keyframes.empty() ? OrbitView() : keyframes.back().view;
            const MoveKeyframe keyframe = read_keyframe(table, before, limits);
            if (keyframes.empty() && keyframe.time_s != 0)
                table.refuse("time_s", "must be 0 in the first keyframe");
            if (!keyframes.empty() && keyframe.time_s <= keyframes.back().time_s)
                table.refuse("time_s", fmt::format("is {}, and it must be later than the keyframe "
                                                   "before, at {}",
                                                   keyframe.time_s, keyframes.back().time_s));
            keyframes.push_back(keyframe);
        });
        if (keyframes.size() < 2 || keyframes.size() > max_keyframes)
            top.refuse("keyframe", fmt::format("stands {} times, and a move has 2 to {} keyframes",
                                               keyframes.size(), max_keyframes));
        if (loop && !is_same_shot(keyframes.front().view, keyframes.back().view))
            top.refuse("loop",
                       "is true, so the last keyframe must show the same view as the first "
                       "(its azimuth may differ by whole turns)");
    });
    return Move(std::move(keyframes), loop, limits);
}

}  // namespace vantage
