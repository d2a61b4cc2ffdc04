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

}  // namespace

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

float aspect_of(const Texture* picture) {
    return picture
               ? static_cast<float>(picture->height_px()) / static_cast<float>(picture->width_px())
               : picture_aspect;
}

}  // namespace vantage
