#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

std::string clock_words(double seconds) {
    const auto whole = static_cast<int>(std::lround(seconds));
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

/// Formats the programme's position.
std::string place_words(const DeskTime& time) {
    if (!time.at) return "live";
    const double from_start_s = (*time.at - time.oldest) / time.rate_hz;
    if (time.is_of_take) return fmt::format("{:.2f} s", from_start_s);
    return fmt::format("-{:.2f} s", std::max(0.0, (time.newest - *time.at) / time.rate_hz));
}

/// Returns the seconds between two labelled ticks.
double tick_step_s(double duration_s, float width_in_ems) {
    constexpr std::array steps{0.1,  0.2,  0.5,  1.0,   2.0,   5.0,
                               10.0, 30.0, 60.0, 300.0, 600.0, 3600.0};
    constexpr double ems_a_tick = 6;
    for (const double step : steps)
        if (duration_s / step * ems_a_tick <= width_in_ems) return step;
    return std::max(steps.back(), duration_s);
}

/// Draws the ticks, with labels at `y`.
void draw_ticks(const Pen& pen, const DeskRect& bar, float y, const DeskTime& time) {
    const double duration_s = (time.newest - time.oldest) / time.rate_hz;
    if (duration_s <= 0) return;
    const double step_s = tick_step_s(duration_s, bar.width / pen.em());
    for (double s = 0; s <= duration_s + 1e-6; s += step_s) {
        // A take counts from its beginning, a stage back from now.
        const double share = time.is_of_take ? s / duration_s : 1 - s / duration_s;
        const float x = bar.left + static_cast<float>(share) * bar.width;
        pen.fill({x - 0.5f, bar.top, 1, bar.height}, palette::tick);
        const std::string words = time.is_of_take
                                      ? step_s < 1 ? fmt::format("{:.1f}", s) : clock_words(s)
                                  : s == 0 ? "now"
                                           : fmt::format("-{:g} s", s);
        const float half = 0.5f * pen.width_of(words);
        pen.text(std::clamp(x - half, bar.left, bar.right() - 2 * half), y, palette::dim, words);
    }
}

/// Draws a mark as a bracket: the in mark opens to the right, the out mark to the left.
void draw_mark(const Pen& pen, const DeskRect& bar, float x, bool is_in) {
    const float thick = std::max(2.0f, 0.16f * pen.em()), arm = 0.45f * pen.em();
    pen.fill({x - 0.5f * thick, bar.top, thick, bar.height}, palette::warn);
    const float left = is_in ? x : x - arm;
    pen.fill({left, bar.top, arm, thick}, palette::warn);
    pen.fill({left, bar.bottom() - thick, arm, thick}, palette::warn);
}

/// Draws the clips along the upper edge; the clip in hand and the playing one have their numbers.
void draw_clips_of(const Pen& pen, const DeskRect& bar, const DeskTime& time,
                   const DeskReplay& replay) {
    const float height = 0.22f * bar.height;
    for (const DeskClip& clip : replay.clips) {
        if (clip.out <= time.oldest || clip.in > time.newest) continue;
        const float from = bar.left + static_cast<float>(time.share_of(clip.in)) * bar.width;
        const float to = bar.left + static_cast<float>(time.share_of(clip.out)) * bar.width;
        const bool is_told = clip.is_in_hand || clip.is_played;
        const ImVec4& colour = clip.is_played    ? palette::on_air
                               : clip.is_in_hand ? palette::accent
                                                 : palette::dim;
        // A gap of one pixel separates neighbours.
        pen.fill({from, bar.top, std::max(2.0f, to - from - 1), height}, colour);
        if (is_told)
            pen.text(from + 0.2f * pen.em(), bar.top + height, colour,
                     fmt::format("{}", clip.number), true);
    }
}

void draw_diamond(const Pen& pen, float x, float y, const ImVec4& colour) {
    const float half = 0.3f * pen.em();
    pen.list().AddQuadFilled({x - half, y}, {x, y - half}, {x + half, y}, {x, y + half},
                             ImGui::GetColorU32(colour));
}

/// Draws the move's keyframes as diamonds along the lower edge.
void draw_keyframes(const Pen& pen, const DeskRect& bar, const DeskTime& time) {
    const float y = bar.bottom() - 0.3f * pen.em();
    for (const double pulse : time.keyframes) {
        if (pulse < time.oldest || pulse > time.newest) continue;
        draw_diamond(pen, bar.left + static_cast<float>(time.share_of(pulse)) * bar.width, y,
                     palette::text);
    }
}

/// Draws the planned move on a line of its own, since its time is not the stage's.
void draw_move(const Pen& pen, float words_left, const DeskRect& line, const DeskState& state) {
    const DeskMove& move = *state.move;
    const float y = line.top + 0.5f * line.height;
    pen.fill(line, palette::trough);
    if (state.move_progress)
        pen.fill({line.left, line.top, static_cast<float>(*state.move_progress) * line.width,
                  line.height},
                 palette::accent);
    for (const double share : move.keyframes)
        draw_diamond(pen, line.left + static_cast<float>(share) * line.width, y,
                     state.move_progress ? palette::text : palette::dim);
    pen.text_until(line.left - 0.4f * pen.em(), words_left, y - 0.5f * pen.em(),
                   state.move_progress ? palette::accent : palette::dim,
                   state.move_progress ? fmt::format("move {:.0f} %", 100 * *state.move_progress)
                                       : fmt::format("move {:.1f} s", move.duration_s));
}

void draw_bar(const Pen& pen, const DeskRect& bar, float words_y, const DeskTime& time,
              const DeskReplay& replay) {
    const auto x_of = [&](double pulse) {
        return bar.left + static_cast<float>(time.share_of(pulse)) * bar.width;
    };
    pen.fill(bar, palette::trough);
    if (time.in || time.out) {
        const float from = x_of(time.in.value_or(time.oldest));
        const float to = x_of(time.out.value_or(time.newest));
        pen.fill({from, bar.top, to - from, bar.height}, palette::between_marks);
    }
    if (time.recorded_s > 0) {
        const float from = x_of(time.newest - time.recorded_s * time.rate_hz);
        const float height = 0.22f * bar.height;
        pen.fill({from, bar.bottom() - height, bar.right() - from, height}, palette::bad);
    }
    draw_ticks(pen, bar, words_y, time);
    draw_clips_of(pen, bar, time, replay);
    draw_keyframes(pen, bar, time);
    if (time.in) draw_mark(pen, bar, x_of(*time.in), true);
    if (time.out) draw_mark(pen, bar, x_of(*time.out), false);
    const float x = x_of(time.at.value_or(time.newest)), half = 0.35f * pen.em();
    pen.fill({x - 0.09f * pen.em(), bar.top, 0.18f * pen.em(), bar.height}, palette::text);
    pen.list().AddTriangleFilled({x - half, bar.top - 0.1f * pen.em()},
                                 {x + half, bar.top - 0.1f * pen.em()}, {x, bar.top + 1.3f * half},
                                 ImGui::GetColorU32(palette::text));
}

}  // namespace

void draw_time_line(const Pen& pen, const DeskRect& rect, const DeskState& state,
                    DeskSpots& spots) {
    if (rect.is_empty()) return;
    const float em = pen.em();
    // A move's line takes some of the bar's height.
    const DeskRect bar{rect.left + 6 * em, rect.top + 0.2f * em, rect.width - 11.5f * em,
                       (state.move ? 1.0f : 1.35f) * em};
    const float y = bar.top + 0.5f * (bar.height - em);
    const float words_y = rect.top + 1.65f * em + (state.move ? 0.2f * em : 0);
    if (state.move)
        draw_move(pen, rect.left, {bar.left, bar.bottom() + 0.2f * em, bar.width, 0.3f * em},
                  state);
    if (!state.time) {
        pen.fill(bar, palette::trough);
        pen.text(bar.left + 0.5f * em, y, palette::dim, "no replay buffer");
        return;
    }
    const DeskTime& time = *state.time;
    pen.text(rect.left, y, time.at ? palette::accent : palette::text, place_words(time), true);
    draw_bar(pen, bar, words_y, time, state.replay);
    // The clickable part includes the labels below the bar.
    spots.time = {{bar.left, rect.top, bar.width, rect.height}, time};
    if (time.is_of_take) return;
    const DeskRect live{bar.right() + 0.6f * em, bar.top, rect.right() - bar.right() - 0.6f * em,
                        bar.height};
    const bool is_live = !time.at && state.signal == SignalState::live;
    if (is_live)
        pen.fill(live, palette::good, 0.2f * em);
    else
        pen.outline(live, palette::good);
    pen.text(live.left + 0.5f * (live.width - pen.width_of("LIVE", true)), y,
             is_live ? palette::on_badge : palette::good, "LIVE", true);
    spots.live = live;
}

}  // namespace vantage
