#include <algorithm>

#include <fmt/format.h>

#include "host_app/desk/air_verdict.h"
#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

/// Share of the background from which it counts as learnt.
constexpr double mostly_known = 0.8;

/// Draws a picture as large as the rectangle allows; returns its width. An outdated picture is
/// dimmed.
float draw_picture(const Pen& pen, const DeskRect& rect, const Texture* picture, bool is_of_now) {
    const float aspect =
        picture ? static_cast<float>(picture->height_px()) / static_cast<float>(picture->width_px())
                : 0.75f;
    const float width = std::min(rect.width, rect.height / aspect);
    const DeskRect place{rect.left, rect.top, width, width * aspect};
    if (picture) pen.image(place, *picture);
    if (picture && !is_of_now) pen.fill(place, palette::veil);
    if (!picture) pen.outline(place, palette::line);
    return width;
}

/// Formats the lost frames by place, such as "lost 15 rig, 1 host  "; empty if none were lost.
std::string lost_words(const DeskRig& rig) {
    std::string words;
    const auto add = [&](std::uint64_t count, const char* place) {
        if (count > 0) words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, place);
    };
    add(rig.lost_at_rig, "rig");
    add(rig.lost_on_the_way, "net");
    add(rig.lost_at_host, "host");
    return words.empty() ? "" : fmt::format("lost {}  ", words);
}

/// Draws the lines below depth and mask, the most important first.
void draw_small_print(const Pen& pen, const DeskRect& rect, const DeskRig& rig) {
    const Clipping clipping(pen, rect);
    float y = rect.top;
    const auto row = [&](const ImVec4& colour, const std::string& words) {
        if (words.empty() || y + pen.em() > rect.bottom()) return;
        pen.text_until(rect.right(), rect.left, y, colour, words);
        y += 1.1f * pen.em();
    };
    if (!rig.worries.empty()) row(palette::warn, rig.worries.front());
    if (rig.background_known) {
        const bool is_learning = *rig.background_known < mostly_known;
        row(is_learning ? palette::warn : palette::dim,
            fmt::format("background {:.0f} %", 100 * *rig.background_known));
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
    const RigStateLabel label = is_of_take && rig.state != RigState::present
                                    ? RigStateLabel{"not in the take", Mark::care}
                                    : label_of(rig.state);
    const float y = cell.top + 0.25f * em;
    float x = pen.mark(cell.left + 0.4f * em, y, label.mark);
    const float right = cell.right() - 0.4f * em;
    x = pen.text_until(right, x, y, palette::text, rig.name, true) + 0.5f * em;
    if (rig.state != RigState::present)
        x = pen.text_until(right, x, y, colour_of(label.mark), label.words, true) + 0.5f * em;
    if (!is_of_take) {
        const std::string numbers =
            fmt::format("{:.1f} fps  {:.0f} ms", rig.rate_hz, rig.latency_ms);
        const std::string lost = lost_words(rig);
        // Lost frames take precedence if there is room for one of the two.
        if (x + pen.width_of(lost + numbers) <= right) {
            pen.text_right(right, y, palette::dim, numbers);
            pen.text_right(right - pen.width_of(numbers), y, palette::warn, lost);
        } else {
            pen.text_until(right, x, y, lost.empty() ? palette::dim : palette::warn,
                           lost.empty() ? numbers : lost);
        }
    }
    const bool is_of_now = rig.state == RigState::present;
    const DeskRect pictures{cell.left, cell.top + 1.6f * em, cell.width, cell.height - 1.6f * em};
    // A high cell keeps a third of its width for depth and mask.
    constexpr float max_width_share = 0.66f;
    DeskRect large = pictures;
    large.width *= max_width_share;
    const float width = draw_picture(pen, large, rig.colour, is_of_now);
    // Depth and mask stand side by side, or one above the other if that makes them larger, with
    // room for text below.
    constexpr float usual_aspect = 0.75f, lines_of_words = 3.6f;
    const float gap = 0.15f * em, left = cell.left + width + gap;
    const float room = cell.right() - left;
    const float high = pictures.height - lines_of_words * pen.line() - gap;
    const float beside = std::min(0.5f * (room - gap), high / usual_aspect);
    const float below = std::min(room, 0.5f * (high - gap) / usual_aspect);
    const bool is_beside = beside >= below;
    DeskRect half{left, pictures.top, std::max(beside, below), 0};
    half.height = usual_aspect * half.width;
    if (half.is_empty()) return;
    draw_picture(pen, half, rig.depth, is_of_now);
    (is_beside ? half.left : half.top) += (is_beside ? half.width : half.height) + gap;
    draw_picture(pen, half, rig.mask, is_of_now);
    draw_small_print(pen,
                     {left + 0.2f * em, half.bottom() + gap, room - 0.2f * em,
                      pictures.bottom() - half.bottom() - gap},
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
