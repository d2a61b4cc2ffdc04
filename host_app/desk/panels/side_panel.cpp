#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

/// Writes lines of text from the top down.
struct Column {
    const Pen& pen;
    float left, right, y;

    float width() const { return right - left; }
    void row(const ImVec4& colour, std::string_view words) {
        pen.text_until(right, left, y, colour, words);
        y += pen.line();
    }
    void wrapped(const ImVec4& colour, std::string_view words) {
        y += pen.text_wrapped(width(), left, y, colour, words);
    }
    void row_of_two(std::string_view name, const ImVec4& colour, std::string_view value) {
        pen.text_right(right, y, colour, value);
        pen.text_until(right - pen.width_of(value) - 0.5f * pen.em(), left, y, palette::dim, name);
        y += pen.line();
    }
    void heading(std::string_view words) {
        y += 0.35f * pen.em();
        pen.text(left, y, palette::dim, words, true);
        y += pen.line();
    }
};

/// Draws the share of the picture that the rigs cover and, outside the corridor, the reason of the
/// loss.
void draw_coverage(Column& column, const Coverage& coverage) {
    const CorridorPlace place = Corridor::place_of(coverage.share);
    if (place == CorridorPlace::inside)
        return column.row(palette::dim, fmt::format("the rigs cover {:.0f} % of the picture",
                                                    100 * coverage.share));
    const Mark mark = place == CorridorPlace::edge ? Mark::care : Mark::bad;
    column.pen.mark(column.left, column.y, mark);
    const float left = column.left;
    column.left += 1.2f * column.pen.em();
    column.wrapped(colour_of(mark), fmt::format("the rigs cover {:.0f} %; most of the rest {}",
                                                100 * coverage.share, words_of(coverage.loss)));
    column.left = left;
}

void draw_camera(Column& column, const DeskState& state) {
    constexpr double deg = 180 / std::numbers::pi;
    const OrbitView& view = state.preview ? state.preview->view : state.view;
    const std::optional<Coverage>& coverage =
        state.preview ? state.preview->coverage : state.coverage;
    column.heading(state.preview ? "CAMERA ON PREVIEW" : "CAMERA");
    column.row(palette::text,
               fmt::format("az {:.1f}\u00b0  el {:.1f}\u00b0  {:.2f} m  FOV {:.1f}\u00b0",
                           view.azimuth_rad * deg, view.elevation_rad * deg, view.distance_m,
                           view.field_of_view_rad * deg));
    column.row(palette::dim,
               fmt::format("pivot {:.2f}  {:.2f}  {:.2f} m{}{}", view.pivot_m.x(), view.pivot_m.y(),
                           view.pivot_m.z(), state.follows_performer ? ", follows a performer" : "",
                           state.holds_horizon ? "" : ", horizon free"));
    if (coverage) draw_coverage(column, *coverage);
    if (state.move_progress) column.row(palette::dim, "on the planned move; steer to take over");
    if (!state.wheel.empty()) column.wrapped(palette::dim, state.wheel);
}

/// Draws the entries around the one that plays, or around the selected one.
void draw_play_list(Column& column, const DeskReplay& replay, DeskSpots* spots) {
    if (replay.entries.empty()) return;
    double all_s = 0;
    std::size_t middle = 0;
    for (std::size_t i = 0; i < replay.entries.size(); ++i) {
        all_s += replay.entries[i].duration_s;
        if (replay.entries[i].is_selected) middle = i;
    }
    for (std::size_t i = 0; i < replay.entries.size(); ++i)
        if (replay.entries[i].is_playing) middle = i;
    column.heading(
        replay.list_left_s
            ? fmt::format("PLAY LIST, {:.1f} s left{}", *replay.list_left_s,
                          replay.list_loops ? ", loops" : "")
            : fmt::format("PLAY LIST, {:.1f} s{}", all_s, replay.list_loops ? ", loops" : ""));
    constexpr std::size_t rows = 6;
    const std::size_t shown = std::min(rows, replay.entries.size());
    const std::size_t first =
        std::min(middle - std::min(middle, rows / 2), replay.entries.size() - shown);
    const Pen& pen = column.pen;
    const float left = column.left, em = pen.em();
    for (std::size_t i = first; i < first + shown; ++i) {
        const DeskEntry& entry = replay.entries[i];
        const float top = column.y;
        const DeskRect row{left, top, column.right - left, pen.line()};
        if (entry.is_selected)
            pen.outline({row.left - 0.2f * em, top - 0.1f * em, row.width + 0.4f * em, row.height},
                        palette::accent);
        const ImVec4& colour = entry.is_playing ? palette::on_air
                               : entry.is_gone  ? palette::warn
                                                : palette::text;
        column.left = left + 0.2f * em;
        column.row_of_two(fmt::format("{}{}. {}{}", entry.is_playing ? "> " : "", i + 1, entry.name,
                                      entry.is_gone ? ", GONE" : ""),
                          colour,
                          entry.speed == 1 ? fmt::format("{:.1f} s", entry.duration_s)
                                           : fmt::format("{:.1f} s, {:.0f} %", entry.duration_s,
                                                         100 * entry.speed));
        column.left = left;
        if (spots) spots->entries.push_back({row, static_cast<int>(i) + 1});
    }
    if (shown < replay.entries.size())
        column.row(palette::dim, fmt::format("{} entries in all", replay.entries.size()));
}

void draw_outputs(Column& column, const DeskState& state, DeskSpots* spots) {
    if (state.outputs.empty() && !state.take && !state.sound) return;
    column.heading("OUTPUTS");
    if (state.sound) {
        const DeskSound& sound = *state.sound;
        column.row_of_two("Sound  " + sound.name, sound.is_on ? palette::good : palette::bad,
                          sound.is_on ? fmt::format("{:.0f} dB", sound.peak_dbfs) : sound.state);
        if (sound.missing_ms > 0)
            column.row(palette::warn, fmt::format("{} ms of sound missing", sound.missing_ms));
        if (!sound.failure.empty()) column.wrapped(palette::bad, sound.failure);
    }
    constexpr int first_key = 5, last_key = 12;
    int number = 1;
    for (const DeskOutput& output : state.outputs) {
        const float top = column.y;
        const int key = first_key + number - 1;
        const std::string value = !output.is_on
                                      ? output.state
                                      : fmt::format("{}, {:.1f} Mbit/s, queue {}", output.state,
                                                    output.mbit_s, output.queued);
        column.row_of_two(key > last_key ? output.name : fmt::format("F{}  {}", key, output.name),
                          output.is_failed ? palette::bad
                          : output.is_on   ? palette::good
                                           : palette::dim,
                          value);
        if (output.left_out > 0)
            column.row(palette::warn, fmt::format("{} frames dropped", output.left_out));
        if (!output.failure.empty()) column.wrapped(palette::bad, output.failure);
        if (spots && key <= last_key)
            spots->outputs.push_back({{column.left, top, column.width(), column.y - top}, number});
        ++number;
    }
    if (!state.take) return;
    const DeskTake& take = *state.take;
    column.row_of_two(take.path, take.is_running ? palette::good : palette::dim,
                      take.is_running ? fmt::format("{:.1f} MB/s", take.mb_s) : "ended");
    if (take.left_out > 0)
        column.row(palette::warn, fmt::format("{} frames not in the take", take.left_out));
    if (!take.trouble.empty()) column.wrapped(palette::warn, take.trouble);
    if (!take.failure.empty()) column.wrapped(palette::bad, take.failure);
}

void draw_sources(Column& column, const DeskSources& sources) {
    column.heading("SOURCE MAP");
    if (!sources.remark.empty()) return column.wrapped(palette::warn, sources.remark);
    const float em = column.pen.em(), left = column.left;
    for (const DeskSources::Row& row : sources.rows) {
        column.pen.fill({left, column.y + 0.1f * em, 0.9f * em, 0.9f * em},
                        {static_cast<float>(row.rgb[0]) / 255, static_cast<float>(row.rgb[1]) / 255,
                         static_cast<float>(row.rgb[2]) / 255, 1});
        column.left = left + 1.3f * em;
        column.row_of_two(row.rig, palette::text, fmt::format("{:.1f} %", 100 * row.share));
        column.left = left;
    }
}

void draw_worries(Column& column, const DeskState& state) {
    for (const DeskRig& rig : state.rigs)
        for (const std::string& worry : rig.worries)
            column.wrapped(palette::warn, fmt::format("{}: {}", rig.name, worry));
    if (!state.computer_worry.empty()) column.wrapped(palette::warn, state.computer_worry);
    if (!state.synchronisation.empty())
        column.wrapped(state.is_sync_doubtful ? palette::warn : palette::dim,
                       "synchronisation: " + state.synchronisation);
}

/// Draws the steps of a frame as a bar in proportion to their durations, with their names below.
void draw_frame_timing(Column& column, const DeskState& state) {
    double all_ms = 0;
    for (const DeskStep& step : state.steps) all_ms += step.ms;
    if (all_ms <= 0) return;
    const Pen& pen = column.pen;
    const float em = pen.em();
    column.heading("FRAME TIMING, ms");
    float x = column.left;
    for (const DeskStep& step : state.steps) {
        const float width = column.width() * static_cast<float>(step.ms / all_ms);
        pen.fill({x, column.y, std::max(1.0f, width - 1), 0.8f * em},
                 step.at_rig ? palette::good : palette::accent);
        x += width;
    }
    column.y += 1.1f * em;
    constexpr std::size_t columns = 3;
    const float gap = em;
    const float width = (column.width() - (columns - 1) * gap) / columns;
    const std::size_t rows = (state.steps.size() + columns - 1) / columns;
    for (std::size_t i = 0; i < state.steps.size(); ++i) {
        const DeskStep& step = state.steps[i];
        const float left = column.left + static_cast<float>(i / rows) * (width + gap);
        Column cell{pen, left, left + width, column.y + static_cast<float>(i % rows) * pen.line()};
        cell.row_of_two(step.name, step.at_rig ? palette::good : palette::accent,
                        fmt::format("{:.1f}", step.ms));
    }
    column.y += static_cast<float>(rows) * pen.line();
    if (state.latencies_ms.empty()) return;
    const float worst = *std::max_element(state.latencies_ms.begin(), state.latencies_ms.end());
    column.row_of_two("exposure to display", palette::text,
                      state.latency_ms > 0
                          ? fmt::format("{:.0f} ms, max {:.0f}", state.latency_ms, worst)
                          : fmt::format("max {:.0f} ms", worst));
}

void draw_figures(Column& column, const DeskState& state) {
    if (state.figures.empty()) return;
    column.heading("SINCE THE START");
    for (const DeskFigure& figure : state.figures)
        column.row_of_two(figure.name, palette::text, figure.value);
}

/// Draws the side panel's text, the most important first; the end is cut off if there is no room.
/// Returns the y at which the text ends.
float draw_words(const Pen& pen, const DeskRect& rect, const DeskState& state, bool figures,
                 DeskSpots* spots) {
    const float pad = 0.6f * pen.em();
    Column column{pen, rect.left + pad, rect.right() - pad, rect.top};
    if (figures) {
        draw_figures(column, state);
    } else {
        draw_camera(column, state);
        draw_play_list(column, state.replay, spots);
        draw_outputs(column, state, spots);
        if (state.sources) draw_sources(column, *state.sources);
    }
    draw_worries(column, state);
    draw_frame_timing(column, state);
    return column.y + 0.4f * pen.em();
}

}  // namespace

void draw_side(const Pen& pen, const DeskRect& rect, const DeskState& state,
               const DeskSwitches& switches, DeskSpots& spots) {
    if (rect.is_empty()) return;
    const float gap = 0.4f * pen.em();
    DeskRect plan = rect, words = rect;
    // A flat panel has the plan and the text side by side.
    constexpr float width_of_words = 20, share_of_words = 0.6f, flat = 1.4f;
    if (rect.width > flat * rect.height) {
        words.width = std::min(width_of_words * pen.em(), share_of_words * rect.width);
        words.left = rect.right() - words.width;
        plan.width = words.left - gap - plan.left;
    } else {
        const float words_height =
            draw_words(pen.dry(), {rect.left, 0, rect.width, 0}, state, switches.figures, nullptr);
        // The 3-D view needs half of the panel.
        const float min_plan =
            switches.outside ? 0.5f * rect.height : std::min(11 * pen.em(), 0.45f * rect.height);
        plan.height = std::max(min_plan, rect.height - words_height - gap);
        words.top = plan.bottom() + gap;
        words.height = rect.bottom() - words.top;
    }
    if (switches.outside) {
        draw_stage_outside(pen, plan, state, switches.eye);
        spots.outside = plan;
    } else {
        draw_stage_plan(pen, plan, state);
    }
    const Clipping clipping(pen, words);
    pen.fill(words, palette::panel);
    draw_words(pen, words, state, switches.figures, &spots);
}

}  // namespace vantage
