#include <algorithm>

#include <fmt/format.h>

#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

constexpr float caption_height = 1.5f;  ///< ems
constexpr float picture_aspect = 9.0f / 16;

/// Draws a picture below its name, coverage and remark; returns the picture's rectangle.
DeskRect draw_monitor(const Pen& pen, const DeskRect& rect, const Texture* picture, float aspect,
                      std::string_view name, const ImVec4& colour,
                      const std::optional<Coverage>& coverage, std::string_view words) {
    const float em = pen.em(), height = caption_height * em;
    const DeskRect below{rect.left, rect.top + height, rect.width, rect.height - height};
    const float thick = std::max(1.0f, 0.12f * em);
    // At the top, if the part is higher than the picture.
    DeskRect place = below.shrunk(thick).fitted(aspect);
    place.top = below.top + thick;
    if (picture) pen.image(place, *picture);
    pen.outline(place.shrunk(-0.5f * thick), colour, thick);
    const float y = rect.top + 0.5f * (height - em);
    float x = pen.badge(rect.left, rect.top, height - 0.15f * em, name, colour);
    if (coverage && Corridor::place_of(coverage->share) != CorridorPlace::inside) {
        const bool is_edge = Corridor::place_of(coverage->share) == CorridorPlace::edge;
        const Mark mark = is_edge ? Mark::care : Mark::bad;
        x = pen.mark(x, y, mark);
        x = pen.text_until(rect.right(), x, y, colour_of(mark),
                           fmt::format("coverage {:.0f} %", 100 * coverage->share)) +
            0.6f * em;
    }
    pen.text_until(rect.right(), x, y, palette::dim, words);
    return place;
}

std::string programme_words(const DeskPreview& preview) {
    constexpr double percent = 100;
    if (preview.fly_progress)
        return fmt::format("flying to the preview, {:.0f} %", percent * *preview.fly_progress);
    if (preview.programme_move)
        return fmt::format("on the planned move, {:.0f} %", percent * *preview.programme_move);
    return fmt::format("cut: ;   auto ({:g} s): '", preview.fly_s);
}

std::string preview_words(const DeskPreview& preview) {
    const std::string rate = fmt::format("{:.1f} fps", preview.picture_rate_hz);
    return preview.is_near_only ? rate + ", coarse outside the programme's view" : rate;
}

/// Draws the pictures of programme and preview.
void draw_monitors(const Pen& pen, const DeskLayout& layout, const DeskState& state,
                   DrawnDesk& drawn) {
    const float aspect = aspect_of(state.picture);
    if (!state.preview) {
        pen.fill(layout.programme, palette::black);
        drawn.picture = layout.programme.fitted(aspect);
        if (state.picture) pen.image(drawn.picture, *state.picture);
        return;
    }
    const DeskPreview& preview = *state.preview;
    drawn.picture = draw_monitor(pen, layout.programme, state.picture, aspect, "PROGRAMME",
                                 palette::on_air, state.coverage, programme_words(preview));
    drawn.preview = draw_monitor(pen, layout.preview, preview.picture, aspect, "PREVIEW",
                                 palette::good, preview.coverage, preview_words(preview));
}

}  // namespace

float aspect_of(const Texture* picture) {
    return picture
               ? static_cast<float>(picture->height_px()) / static_cast<float>(picture->width_px())
               : picture_aspect;
}

DrawnDesk draw_desk(const DeskState& state, const DeskSwitches& switches, const UiFonts& fonts) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Pen pen(fonts);
    pen.fill({0, 0, size.x, size.y}, palette::ground);
    const bool has_preview = state.preview.has_value();
    const DeskLayout layout =
        switches.panels
            ? desk_layout(
                  size.x, size.y, pen.em(),
                  switches.rigs && !switches.rigs_apart ? static_cast<int>(state.rigs.size()) : 0,
                  aspect_of(state.picture), !state.replay.clips.empty(), has_preview)
            : pictures_alone(size.x, size.y, has_preview);
    DrawnDesk drawn;
    draw_monitors(pen, layout, state, drawn);
    if (switches.panels) {
        draw_status(pen, layout.status, state);
        draw_shots(pen, layout.shots, state, drawn.spots);
        draw_clips(pen, layout.clips, state, drawn.spots);
        draw_side(pen, layout.side, state, switches, drawn.spots);
        draw_time_line(pen, layout.time_line, state, drawn.spots);
        draw_multiview(pen, layout.rigs, layout.rig_rows, state);
    }
    drawn.has_overlay = switches.help > 0 || state.wheel_map;
    if (state.wheel_map) draw_wheel_map(pen, size.x, size.y, *state.wheel_map, drawn.spots);
    if (switches.help > 0) drawn.help_pages = draw_help(pen, size.x, size.y, switches.help);
    return drawn;
}

}  // namespace vantage
