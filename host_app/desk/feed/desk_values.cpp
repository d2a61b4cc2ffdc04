#include "host_app/desk/feed/desk_values.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "common/base/time/timecode.h"
#include "host_app/control/hid/jog_mapper.h"

namespace vantage {
namespace {

const char* loss_of(ClipPresence presence) {
    switch (presence) {
        case ClipPresence::whole:
            break;
        case ClipPresence::part:
            return "PART GONE";
        case ClipPresence::gone:
            return "GONE";
    }
    return "";
}

constexpr int response_samples = 65;
/// Range of the graph of a wheel without end stops, in detents either way.
constexpr double graph_detents = 5;

DeskWheel::Kind kind_of(JogKind kind) {
    switch (kind) {
        case JogKind::step:
            return DeskWheel::Kind::turns;
        case JogKind::axis:
            return DeskWheel::Kind::axis;
        case JogKind::button:
            break;
    }
    return DeskWheel::Kind::button;
}

/// The response of a control as JogMapper computes it.
double asked_for(const AxisMap& map, bool has_rest, double at) {
    const double gain = map.sensitivity * (map.inverted ? -1 : 1);
    if (!has_rest) return gain * at;
    const double way = response_of(map, at);
    return gain * (map.action == AxisAction::shuttle ? shuttle_speed(way) : way);
}

DeskWheel::Feel feel_of(const WheelMapView& view, const WheelMapView::Control& control) {
    const AxisMap& map = view.feel;
    const bool has_rest = control.control.kind == JogKind::axis;
    DeskWheel::Feel feel;
    feel.steps = map.sensitivity;
    feel.dead_zone = map.dead_zone;
    feel.curve = map.curve;
    feel.inverted = map.inverted;
    feel.to = has_rest ? 1 : graph_detents;
    feel.from = -feel.to;
    feel.unit = !has_rest                           ? "steps"
                : map.action == AxisAction::shuttle ? "x speed"
                                                    : "of full speed";
    for (int i = 0; i < response_samples; ++i)
        feel.response.push_back(static_cast<float>(asked_for(
            map, has_rest, feel.from + i * (feel.to - feel.from) / (response_samples - 1))));
    feel.most = std::abs(asked_for(map, has_rest, feel.to));
    feel.at = has_rest ? control.at : std::clamp(view.turned, feel.from, feel.to);
    feel.asks = asked_for(map, has_rest, has_rest ? control.at : view.turned);
    return feel;
}

}  // namespace

std::vector<DeskFigure> desk_figures(const LiveReport& report) {
    const ProgrammeStats& programme = report.programme;
    if (programme.ticks == 0) return {};
    std::vector<DeskFigure> figures{
        {"ticks, reprojected, repeated, missed",
         fmt::format("{}, {}, {}, {}", programme.ticks, programme.reprojected, programme.repeated,
                     programme.missed)}};
    const auto add_ms = [&](const char* name, const Percentiles& ms) {
        if (ms.count > 0)
            figures.push_back(
                {name, fmt::format("{:.0f} ms, p99 {:.0f}, max {:.0f}", ms.p50, ms.p99, ms.max)});
    };
    add_ms("between frames", programme.interval_ms);
    add_ms("exposure to picture", programme.latency_ms);
    add_ms("input to picture", programme.input_ms);
    add_ms("seek to picture", programme.seek_ms);
    figures.push_back({"instants, skipped", fmt::format("{}, {}", report.instants_prepared,
                                                        report.frame_sets_replaced)});
    figures.push_back({"rendering, by level", shares_text(programme.render_shares)});
    figures.push_back({"preparing, by level", shares_text(programme.prepare_shares)});
    return figures;
}

DeskReplay desk_replay(const ProgrammeState& programme, const ClipPictures& pictures,
                       int tai_offset_s) {
    const ReplayState& replay = programme.replay;
    DeskReplay desk;
    if (!replay.book) return desk;
    const ClipBook& book = *replay.book;
    const TimecodeClock clock(book.pulse_rate_hz);
    for (const auto& [number, clip] : book.clips) {
        DeskClip& shown = desk.clips.emplace_back();
        shown.number = number;
        // Without a name the in point's time code, shortened to the width of the bin.
        shown.name =
            clip.name.empty()
                ? clock.of_pulse(clip.in, tai_offset_s).substr(0, std::size("hh:mm:ss") - 1)
                : clip.name;
        shown.in = static_cast<double>(clip.in);
        shown.out = static_cast<double>(clip.out);
        shown.speed = clip.speed;
        shown.duration_s = clip.duration_s(book.pulse_rate_hz);
        shown.is_in_hand = number == replay.hand;
        shown.is_played = number == replay.clip;
        shown.loss = loss_of(presence_of(clip, programme.past));
        shown.picture = pictures.of(number);
    }
    for (std::size_t place = 0; place < book.list.size(); ++place) {
        const PlayEntry& entry = book.list[place];
        const Clip& clip = book.clips.at(entry.clip);
        DeskEntry& shown = desk.entries.emplace_back();
        const std::string in = clock.of_pulse(clip.in, tai_offset_s);
        shown.name = clip.name.empty() ? fmt::format("{}  {}", entry.clip, in)
                                       : fmt::format("{} {}  {}", entry.clip, clip.name, in);
        shown.speed = entry.speed.value_or(clip.speed);
        shown.duration_s = clip.duration_s(book.pulse_rate_hz) / shown.speed;
        shown.is_selected = replay.selected == place;
        shown.is_playing = replay.playing == place;
        shown.is_gone = presence_of(clip, programme.past) == ClipPresence::gone;
    }
    desk.list_loops = book.list_loops;
    desk.programme_speed = book.programme_speed;
    desk.clip = replay.clip;
    desk.clip_left_s = replay.clip_left_s;
    desk.list_left_s = replay.list_left_s;
    desk.fast_jog = replay.fast_jog;
    return desk;
}

std::optional<DeskWheel> desk_wheel(const std::optional<WheelMapView>& view) {
    if (!view) return std::nullopt;
    DeskWheel wheel;
    wheel.name = view->name;
    wheel.file = view->file;
    wheel.selected = view->selected;
    wheel.is_changed = view->is_changed;
    wheel.remark = view->remark;
    for (const WheelMapView::Control& control : view->controls)
        wheel.controls.push_back({kind_of(control.control.kind), control.control.name, control.does,
                                  control.is_held, control.at});
    if (view->selected < view->controls.size() &&
        view->controls[view->selected].control.kind != JogKind::button)
        wheel.feel = feel_of(*view, view->controls[view->selected]);
    return wheel;
}

RigState state_in(const FrameSet* set, const RigStatus& status) {
    if (!status.refused.empty()) return RigState::refused;
    if (!status.connected) return RigState::disconnected;
    const RigState absent = status.received == 0 ? RigState::starting : RigState::late;
    if (!set) return absent;
    for (const FrameSet::Slot& slot : set->slots) {
        if (slot.rig != status.rig) continue;
        if (slot.frame && slot.frame->has_pictures()) return RigState::present;
        if (slot.absence == Absence::missed_by_rig) return RigState::missed;
        if (slot.absence == Absence::disconnected) return RigState::disconnected;
    }
    return absent;
}

std::optional<double> live_age_s(const ProgrammeState& programme) {
    if (!programme.picture || programme.time.pulse || programme.time.is_held) return std::nullopt;
    const ReadyInstant& instant = *programme.picture->job.instant;
    if (!instant.is_live || !instant.exposure) return std::nullopt;
    return std::chrono::duration<double>(TaiClock::now() - *instant.exposure).count();
}

}  // namespace vantage
