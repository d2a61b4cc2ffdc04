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

namespace {

// Lengths in ems, the font height.
constexpr float cells_gap = 0.4f, status_height = 2.5f, time_line_height = 2.9f, side_width = 23;
/// Smallest window with a side panel and with a row of rigs. A smaller one has room only for the
/// programme, the status bar and the time line.
constexpr float min_width_with_side = 62, min_height_with_rigs = 32;

/// Height of the caption of a rig's cell, and the cell's width in heights of its colour picture.
constexpr float cell_caption_height = 1.6f, cell_aspect = 2.2f;
/// Largest and smallest share of the window's height for the rigs' pictures.
constexpr float max_rigs_height = 0.19f, min_rigs_height = 0.1f;

float rig_picture_height(float width, float height, float rigs, float rows) {
    const float columns = std::ceil(rigs / rows);
    return std::min((width / columns - cells_gap) / cell_aspect, max_rigs_height * height / rows);
}

/// The programme's share of the width beside the preview, the preview's share of the height above
/// the side panel, and the height of a picture's name.
constexpr float programme_share = 0.6f, preview_share = 0.64f, name_height = 1.5f;

/// Splits the programme's rectangle. The preview is on the left, as on a vision mixer.
void halve(DeskLayout& layout, float between) {
    DeskRect& programme = layout.programme;
    layout.preview = programme;
    layout.preview.width = programme.width = 0.5f * (programme.width - between);
    programme.left += programme.width + between;
}

}  // namespace

DeskRect DeskRect::fitted(float aspect) const {
    const float fitted_width = std::min(width, height / aspect);
    const float fitted_height = fitted_width * aspect;
    return {left + 0.5f * (width - fitted_width), top + 0.5f * (height - fitted_height),
            fitted_width, fitted_height};
}

float letter_height_px(float width_px, float height_px, float content_scale) {
    // A window has 54 lines of text, but text below 9 px cannot be read.
    constexpr float rows = 54, columns = 96, min_px = 9;
    return std::round(
        std::max(std::min(height_px / rows, width_px / columns), min_px * content_scale));
}

DeskLayout desk_layout(float width_px, float height_px, float em_px, int rigs, float aspect,
                       bool has_clips, bool has_preview) {
    const float width = width_px / em_px, height = height_px / em_px;
    DeskLayout layout;
    layout.status = {0, 0, width, status_height};
    float bottom = height;
    if (rigs > 0 && height >= min_height_with_rigs) {
        const auto count = static_cast<float>(rigs);
        float rows = 1;
        while (rig_picture_height(width, height, count, rows) < min_rigs_height * height / rows &&
               rows < 3)
            ++rows;
        layout.rig_rows = static_cast<int>(rows);
        const float all =
            rows * (rig_picture_height(width, height, count, rows) + cell_caption_height);
        layout.rigs = {0, bottom - all, width, all};
        bottom = layout.rigs.top - cells_gap;
    }
    layout.time_line = {cells_gap, bottom - time_line_height, width - 2 * cells_gap,
                        time_line_height};
    bottom = layout.time_line.top - cells_gap;
    const float top = status_height + cells_gap;
    const float middle = std::max(bottom - top, 1.0f);
    float right = width - cells_gap;
    if (width >= min_width_with_side) {
        const float shot_height = middle / shot_places - cells_gap;
        const float shot_width = std::min(shot_height / aspect, 0.11f * width);
        const float bins = has_clips ? 2 : 1;
        // The side panel takes the width that the picture leaves.
        const float both_width = right - bins * (shot_width + cells_gap) - 2 * cells_gap;
        const float picture_width =
            has_preview ? std::min((middle - name_height) / aspect, programme_share * both_width)
                        : std::min(middle / aspect, both_width - side_width);
        const float side_left = 2 * cells_gap + picture_width + bins * (shot_width + cells_gap);
        layout.shots = {2 * cells_gap + picture_width, top, shot_width, middle};
        if (has_clips) layout.clips = {layout.shots.right() + cells_gap, top, shot_width, middle};
        layout.side = {side_left, top, right - side_left, middle};
        if (has_preview) {
            layout.preview = layout.side;
            layout.preview.height =
                std::min(name_height + layout.side.width * aspect, preview_share * middle);
            layout.side.top = layout.preview.bottom() + cells_gap;
            layout.side.height -= layout.preview.height + cells_gap;
        }
        right = cells_gap + picture_width;
    }
    layout.programme = {cells_gap, top, right - cells_gap, middle};
    if (has_preview && layout.side.is_empty()) halve(layout, cells_gap);
    for (DeskRect* part : {&layout.status, &layout.programme, &layout.preview, &layout.shots,
                           &layout.clips, &layout.side, &layout.time_line, &layout.rigs})
        *part = {part->left * em_px, part->top * em_px, part->width * em_px, part->height * em_px};
    return layout;
}

int best_rig_rows(float width_px, float height_px, float em_px, int rigs) {
    int best = 1;
    float largest = 0;
    for (int rows = 1; rows <= rigs; ++rows) {
        const float columns = std::ceil(static_cast<float>(rigs) / static_cast<float>(rows));
        const float height =
            std::min(width_px / columns / cell_aspect,
                     height_px / static_cast<float>(rows) - cell_caption_height * em_px);
        if (height <= largest) continue;
        largest = height;
        best = rows;
    }
    return best;
}

DeskLayout pictures_alone(float width_px, float height_px, bool has_preview) {
    DeskLayout layout;
    layout.programme = {0, 0, width_px, height_px};
    if (has_preview) halve(layout, 0);
    return layout;
}

}  // namespace vantage
