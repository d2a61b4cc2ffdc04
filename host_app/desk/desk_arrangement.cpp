#include "host_app/desk/desk_arrangement.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/config/toml_reader.h"
#include "common/gl/context/limits.h"

namespace vantage {
namespace {

constexpr int desk_file_version = 1;
constexpr double rad_a_degree = std::numbers::pi / 180;
/// Of all the monitors that one computer has.
constexpr int farthest_px = 100'000;

void read_eye(TomlTable& table, OutsideEye& eye) {
    OutsideEye read;
    double azimuth_deg = read.azimuth_rad / rad_a_degree,
           elevation_deg = read.elevation_rad / rad_a_degree;
    double nearness = 0;
    table.read("azimuth_deg", azimuth_deg, {-360, 360});
    table.read("elevation_deg", elevation_deg, {0, 90});
    table.read("nearness", nearness, {-10, 10});
    eye = {azimuth_deg * rad_a_degree, 0, 0};
    // Within its own bounds.
    eye.turn(0, elevation_deg * rad_a_degree);
    eye.go_nearer(nearness);
}

void read_window(TomlTable& table, WindowPlace& window) {
    constexpr int least_width_px = 320, least_height_px = 240;
    for (const char* key : {"x", "y", "width", "height"}) table.require(key);
    table.read("x", window.x, {-farthest_px, farthest_px});
    table.read("y", window.y, {-farthest_px, farthest_px});
    table.read("width", window.width, {least_width_px, PiLimits::max_image_side_px});
    table.read("height", window.height, {least_height_px, PiLimits::max_image_side_px});
    table.read("maximised", window.is_maximised);
}

std::string window_text(const char* name, const std::optional<WindowPlace>& window) {
    if (!window) return "";
    return fmt::format("\n[{}]\nx = {}\ny = {}\nwidth = {}\nheight = {}\nmaximised = {}\n", name,
                       window->x, window->y, window->width, window->height, window->is_maximised);
}

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
        "# How the desk of Vantage is arranged; docs/desk_file.md explains the keys.\nversion = "
        "{}\n"
        "panels = {}\nrigs = {}\nrigs_apart = {}\nfigures = {}\noutside = {}\n\n[eye]\nazimuth_deg "
        "= {:.1f}\n"
        "elevation_deg = {:.1f}\nnearness = {:.2f}\n",
        desk_file_version, switches.panels, switches.rigs, switches.rigs_apart, switches.figures,
        switches.outside,
        std::remainder(switches.eye.azimuth_rad, 2 * std::numbers::pi) / rad_a_degree,
        switches.eye.elevation_rad / rad_a_degree, switches.eye.nearness);
    return text + window_text("window", desk.window) + window_text("rigs_window", desk.rigs_window);
}

}  // namespace vantage
