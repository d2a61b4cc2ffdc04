#include "host_app/desk/desk_arrangement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/config/toml_reader.h"
#include "common/gl/context/limits.h"

namespace vantage {
namespace {

constexpr int desk_file_version = 1;
constexpr double rad_a_degree = std::numbers::pi / 180;
/// Largest coordinate of a window: more than all monitors of one computer together.
constexpr int max_coordinate_px = 100'000;

void read_eye(TomlTable& table, OutsideEye& eye) {
    OutsideEye read;
    double azimuth_deg = read.azimuth_rad / rad_a_degree,
           elevation_deg = read.elevation_rad / rad_a_degree;
    double nearness = 0;
    table.read("azimuth_deg", azimuth_deg, {-360, 360});
    table.read("elevation_deg", elevation_deg, {0, 90});
    table.read("nearness", nearness, {-10, 10});
    eye = {azimuth_deg * rad_a_degree, 0, 0};
    eye.turn(0, elevation_deg * rad_a_degree);
    eye.go_nearer(nearness);
}

void read_window(TomlTable& table, WindowPlace& window) {
    constexpr int min_width_px = 320, min_height_px = 240;
    for (const char* key : {"x", "y", "width", "height"}) table.require(key);
    table.read("x", window.x, {-max_coordinate_px, max_coordinate_px});
    table.read("y", window.y, {-max_coordinate_px, max_coordinate_px});
    table.read("width", window.width, {min_width_px, PiLimits::max_image_side_px});
    table.read("height", window.height, {min_height_px, PiLimits::max_image_side_px});
    table.read("maximised", window.is_maximised);
}

std::string window_text(const char* name, const std::optional<WindowPlace>& window) {
    if (!window) return "";
    return fmt::format("\n[{}]\nx = {}\ny = {}\nwidth = {}\nheight = {}\nmaximised = {}\n", name,
                       window->x, window->y, window->width, window->height, window->is_maximised);
}

/// Limits of the 3-D view: above the floor, below straight down, and with the stage in sight.
constexpr double min_eye_elevation_rad = 0.02, max_eye_elevation_rad = 1.5;
constexpr double min_nearness = -0.7, max_nearness = 2;

}  // namespace

DeskArrangement load_desk(const std::filesystem::path& path) {
    DeskArrangement desk;
    DeskSwitches& switches = desk.switches;
    read_toml_file(path, desk_file_version, [&](TomlTable& top) {
        top.read("panels", switches.panels);
        top.read("rigs", switches.rigs);
        top.read("rigs_apart", switches.rigs_apart);
        top.read("figures", switches.figures);
        top.read("outside", switches.outside);
        top.read_table("eye", [&](TomlTable& table) { read_eye(table, switches.eye); });
        top.read_table("window",
                       [&](TomlTable& table) { read_window(table, desk.window.emplace()); });
        top.read_table("rigs_window",
                       [&](TomlTable& table) { read_window(table, desk.rigs_window.emplace()); });
    });
    return desk;
}

std::string to_toml(const DeskArrangement& desk) {
    const DeskSwitches& switches = desk.switches;
    std::string text = fmt::format(
        "# The arrangement of Vantage's desk; docs/reference/formats.md explains the "
        "keys.\nversion = {}\n"
        "panels = {}\nrigs = {}\nrigs_apart = {}\nfigures = {}\noutside = {}\n\n[eye]\nazimuth_deg "
        "= {:.1f}\n"
        "elevation_deg = {:.1f}\nnearness = {:.2f}\n",
        desk_file_version, switches.panels, switches.rigs, switches.rigs_apart, switches.figures,
        switches.outside,
        std::remainder(switches.eye.azimuth_rad, 2 * std::numbers::pi) / rad_a_degree,
        switches.eye.elevation_rad / rad_a_degree, switches.eye.nearness);
    return text + window_text("window", desk.window) + window_text("rigs_window", desk.rigs_window);
}

void OutsideEye::turn(double azimuth_by_rad, double elevation_by_rad) {
    azimuth_rad += azimuth_by_rad;
    elevation_rad =
        std::clamp(elevation_rad + elevation_by_rad, min_eye_elevation_rad, max_eye_elevation_rad);
}

void OutsideEye::go_nearer(double by) {
    nearness = std::clamp(nearness + by, min_nearness, max_nearness);
}

DeskStore::DeskStore(std::filesystem::path file)
    : file_(std::move(file), "the desk's arrangement") {
    if (file_.is_there()) desk_ = load_desk(file_.path());
}

void DeskStore::follow(const DeskArrangement& desk, MonotonicTime now) {
    // The first position of a window is chosen by the window manager, not by the operator.
    const bool is_changed = desk.switches != desk_.switches ||
                            (desk_.window && desk.window != desk_.window) ||
                            (desk_.rigs_window && desk.rigs_window != desk_.rigs_window);
    if (is_changed) file_.note_change();
    desk_ = desk;
    if (file_.is_due(now)) (void)file_.write(to_toml(desk_));
}

void DeskStore::finish() {
    if (file_.is_changed()) (void)file_.write(to_toml(desk_));
}

std::filesystem::path desk_file_of(std::filesystem::path file) {
    return file.replace_extension(".desk.toml");
}

}  // namespace vantage
