#include <algorithm>

#include <fmt/format.h>

#include "host_app/desk/desk_parts.h"
#include "host_app/desk/rig_look.h"

namespace vantage {
namespace {

/// Of a set that counts as learnt.
constexpr double mostly_known = 0.8;

/// A picture as large as fits into the rectangle's height; returns its width.
float draw_picture(const Pen& pen, const DeskRect& rect, const Texture* picture, bool is_of_now) {
    const float aspect =
        picture ? static_cast<float>(picture->height_px()) / static_cast<float>(picture->width_px())
                : 0.75f;
    const float width = std::min(rect.width, rect.height / aspect);
    const DeskRect place{rect.left, rect.top, width, width * aspect};
    if (picture) pen.image(place, *picture);
    // What is not of now stays, as what it was.
    if (picture && !is_of_now) pen.fill(place, palette::veil);
    if (!picture) pen.outline(place, palette::line);
    return width;
}

/// Under the depth picture, the most important first.
void draw_small_print(const Pen& pen, const DeskRect& rect, const DeskRig& rig) {
    const Clipping clipping(pen, rect);
    float y = rect.top;
    const auto row = [&](const ImVec4& colour, const std::string& words) {
        if (words.empty() || y + pen.em() > rect.bottom()) return;
        pen.text_until(rect.right(), rect.left, y, colour, words);
        y += 1.1f * pen.em();
    };
    if (!rig.worries.empty()) row(palette::warn, rig.worries.front());
    if (rig.set_known) {
        const bool is_learning = *rig.set_known < mostly_known;
        row(is_learning ? palette::warn : palette::dim,
            fmt::format("set {:.0f} %", 100 * *rig.set_known));
    }
    if (rig.nearest_m > 0)
        row(palette::dim, fmt::format("{:.1f} to {:.1f} m", rig.nearest_m, rig.farthest_m));
    const std::string heat =
        rig.temperature_c ? fmt::format("{:.0f}\u00b0C  ", *rig.temperature_c) : "";
    row(palette::dim, heat + rig.clock);
    row(palette::dim, rig.calibration);
}

void draw_rig(const Pen& pen, const DeskRect& cell, const DeskRig& rig, bool is_of_take) {
    const float em = pen.em();
    pen.fill(cell, palette::panel);
    const RigLook look = is_of_take && rig.state != RigState::present
                             ? RigLook{"not in the take", Mark::care}
                             : look_of(rig.state);
    const float y = cell.top + 0.25f * em;
    float x = pen.mark(cell.left + 0.4f * em, y, look.mark);
    const float right = cell.right() - 0.4f * em;
    x = pen.text_until(right, x, y, palette::text, rig.name, true) + 0.5f * em;
    if (rig.state != RigState::present)
        x = pen.text_until(right, x, y, colour_of(look.mark), look.words, true) + 0.5f * em;
    if (!is_of_take) {
        const std::string numbers = fmt::format("{:.1f}/s  {:.0f} ms", rig.rate_hz, rig.latency_ms);
        // At the rig, on the way, at this host.
        const std::string lost = rig.lost() > 0 ? fmt::format("lost {}/{}/{}  ", rig.lost_at_rig,
                                                              rig.lost_on_the_way, rig.lost_at_host)
                                                : "";
        if (x + pen.width_of(lost + numbers) <= right) {
            pen.text_right(right, y, palette::dim, numbers);
            pen.text_right(right - pen.width_of(numbers), y, palette::warn, lost);
        }
    }
    const bool is_of_now = rig.state == RigState::present;
    const DeskRect pictures{cell.left, cell.top + 1.6f * em, cell.width, cell.height - 1.6f * em};
    const float width = draw_picture(pen, pictures, rig.colour, is_of_now);
    const float left = cell.left + width + 0.15f * em;
    const DeskRect beside{left, pictures.top, cell.right() - left, 0.62f * pictures.height};
    if (beside.is_empty()) return;
    draw_picture(pen, beside, rig.depth, is_of_now);
    draw_small_print(pen,
                     {left + 0.2f * em, beside.bottom() + 0.15f * em, beside.width - 0.2f * em,
                      pictures.height - beside.height - 0.15f * em},
                     rig);
}

}  // namespace

void draw_multiview(const Pen& pen, const DeskRect& rect, int rows, const DeskState& state) {
    if (rect.is_empty() || state.rigs.empty()) return;
    const int count = static_cast<int>(state.rigs.size());
    const int columns = (count + rows - 1) / rows;
    const float gap = 0.3f * pen.em();
    const float width = rect.width / static_cast<float>(columns);
    const float height = rect.height / static_cast<float>(rows);
    for (int i = 0; i < count; ++i)
        draw_rig(pen,
                 {rect.left + static_cast<float>(i % columns) * width,
                  rect.top + static_cast<float>(i / columns) * height, width - gap, height},
                 state.rigs[static_cast<std::size_t>(i)], state.is_of_take());
}

}  // namespace vantage
