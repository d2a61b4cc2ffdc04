#include <algorithm>

#include <fmt/format.h>

#include "host_app/desk/air_verdict.h"
#include "host_app/desk/panels/desk_parts.h"

namespace vantage {
namespace {

const ImVec4& colour_of(SignalState signal) {
    switch (signal) {
        case SignalState::live:
            return palette::good;
        case SignalState::hold:
            return palette::accent;
        case SignalState::stale:
            return palette::warn;
        case SignalState::no_signal:
            break;
    }
    return palette::bad;
}

RigStateLabel verdict_label(AirVerdict::Level level) {
    switch (level) {
        case AirVerdict::Level::ready:
            return {"READY FOR AIR", Mark::good};
        case AirVerdict::Level::caution:
            return {"CAUTION", Mark::care};
        case AirVerdict::Level::not_ready:
            break;
    }
    return {"NOT FOR AIR", Mark::bad};
}

/// Returns the x at which text may follow.
float draw_verdict(const Pen& pen, float x, float y, float right, const DeskState& state) {
    const AirVerdict verdict = air_verdict(state);
    const RigStateLabel label = verdict_label(verdict.level);
    const ImVec4& colour = vantage::colour_of(label.mark);
    x = pen.mark(x, y, label.mark);
    x = pen.text(x, y, colour, label.words, true) + 0.5f * pen.em();
    if (!verdict.why.empty()) x = pen.text_until(right, x, y, colour, verdict.why);
    return x + 1.2f * pen.em();
}

float draw_time(const Pen& pen, float x, float y, float height, const DeskState& state) {
    if (state.behind_s)
        x = pen.badge(x, y, height, fmt::format("{:.1f} s BEHIND", *state.behind_s),
                      palette::accent);
    else if (state.is_of_take())
        x = pen.badge(x, y, height, "TAKE", palette::accent);
    else if (!state.waiting)
        x = pen.badge(x, y, height, title_of(state.signal), colour_of(state.signal));
    if (!state.time || !state.time->at) return x;
    const DeskTime& time = *state.time;
    const std::string speed = time.speed == 0 ? "HOLD" : fmt::format("PLAY {:g}x", time.speed);
    return pen.badge(x, y, height, speed + (time.loops ? " LOOP" : ""), palette::accent);
}

/// Draws the clip or the entry that plays, with the time that is left.
float draw_replay(const Pen& pen, float x, float y, float height, const DeskReplay& replay) {
    if (replay.fast_jog) x = pen.badge(x, y, height, "JOG 10x", palette::accent);
    if (replay.clip == 0 || !replay.clip_left_s) return x;
    const auto playing = std::find_if(replay.entries.begin(), replay.entries.end(),
                                      [](const DeskEntry& entry) { return entry.is_playing; });
    if (playing == replay.entries.end())
        return pen.badge(x, y, height,
                         fmt::format("CLIP {}  -{:.1f} s", replay.clip, *replay.clip_left_s),
                         palette::on_air);
    return pen.badge(
        x, y, height,
        fmt::format("LIST {}/{}  -{:.1f}  -{:.1f} s", playing - replay.entries.begin() + 1,
                    replay.entries.size(), *replay.clip_left_s, replay.list_left_s.value_or(0)),
        palette::on_air);
}

float draw_recordings(const Pen& pen, float x, float y, float height, const DeskState& state) {
    if (state.recording) x = pen.badge(x, y, height, "REC FILM", palette::bad);
    if (state.recording_flight) x = pen.badge(x, y, height, "REC FLIGHT", palette::bad);
    if (!state.take) return x;
    if (!state.take->is_running) return pen.badge(x, y, height, "TAKE ENDED", palette::warn);
    const auto seconds = static_cast<int>(state.take->duration_s);
    return pen.badge(x, y, height, fmt::format("REC TAKE {}:{:02}", seconds / 60, seconds % 60),
                     palette::bad);
}

/// Draws picture size, quality, rates and latency, as far as there is room.
void draw_numbers(const Pen& pen, float left, float right, float y, const DeskState& state) {
    const std::string latency =
        state.latency_ms > 0 ? fmt::format("   {:.0f} ms", state.latency_ms) : "";
    const std::string rate =
        fmt::format("{:.1f} of {:.4g} fps", state.picture_rate_hz, state.tick_rate_hz);
    const std::string repeated =
        state.repeated > 0 ? fmt::format(", {} repeated", state.repeated) : "";
    const std::string help = latency + "   F1: help";
    const std::string quality =
        fmt::format("{}x{}   {}, level {}/{}   ", state.picture ? state.picture->width_px() : 0,
                    state.picture ? state.picture->height_px() : 0, state.synthesiser,
                    state.render_level, state.prepare_level);
    for (const std::string& words : {quality + rate + repeated + help, rate + repeated + help,
                                     rate + help, std::string("F1: help")})
        if (left + pen.width_of(words) <= right) {
            pen.text_right(right, y, palette::dim, words);
            return;
        }
}

}  // namespace

void draw_status(const Pen& pen, const DeskRect& rect, const DeskState& state) {
    pen.fill(rect, palette::panel);
    const float pad = 0.7f * pen.em(), height = 1.55f * pen.em();
    const float top = rect.top + 0.5f * (rect.height - height);
    const float y = rect.top + 0.5f * (rect.height - pen.em());
    float x = rect.left + pad;
    const float right = rect.right() - pad;
    if (state.programme_tally) x = pen.badge(x, top, height, "ON AIR", palette::on_air);
    if (state.preview_tally) x = pen.badge(x, top, height, "PREVIEW", palette::good);
    x = draw_verdict(pen, x, y, x + 0.42f * rect.width, state);
    x = draw_time(pen, x, top, height, state);
    x = draw_replay(pen, x, top, height, state.replay);
    x = draw_recordings(pen, x, top, height, state);
    if (!state.waiting) {
        x = pen.text_until(right, x, y, palette::text, state.timecode, true) + pad;
        if (!state.ltc.empty())
            x = pen.text_until(right, x, y, state.is_ltc_off ? palette::warn : palette::dim,
                               state.ltc, true) +
                pad;
        const std::string pulse = fmt::format("pulse {}", state.pulse);
        if (rect.width > 80 * pen.em()) x = pen.text(x, y, palette::dim, pulse) + pad;
    }
    // A question, the command line or a notice covers the numbers.
    const std::string& words = !state.question.empty() ? state.question
                               : !state.typed.empty()  ? state.typed
                                                       : state.notice;
    if (words.empty()) return draw_numbers(pen, x, right, y, state);
    const float width = std::min(pen.width_of(words, true) + pad, rect.width - pad);
    const DeskRect box{right - width, top, width, height};
    pen.fill(box, state.typed.empty() ? palette::warn : palette::text, 0.2f * pen.em());
    pen.text_until(box.right(), box.left + 0.5f * pad, y, palette::on_badge, words, true);
}

}  // namespace vantage
