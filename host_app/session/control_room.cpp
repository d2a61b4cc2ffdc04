#include "host_app/session/control_room.h"

#include <algorithm>
#include <cmath>

#include "common/base/memory_pressure.h"
#include "host_app/desk/feed/desk_values.h"
#include "host_app/session/report/live_report.h"

namespace vantage {
namespace {

/// Period of the time code's lamp: more often it would only load the ports.
constexpr std::chrono::milliseconds timecode_period{250};

}  // namespace

const char* key_of(AirVerdict::Level level) {
    switch (level) {
        case AirVerdict::Level::ready:
            return "ready";
        case AirVerdict::Level::caution:
            return "caution";
        case AirVerdict::Level::not_ready:
            break;
    }
    return "not_ready";
}

bool AirWatch::follow(const LiveShow& show, const std::optional<TakeState>& take,
                      MonotonicTime now) {
    constexpr std::chrono::milliseconds period{250};
    if (seen_ && now - refreshed_ < period) return false;
    refreshed_ = now;
    const ProgrammeState programme = show.state();
    Seen seen;
    seen.report = show.report();
    const FrameSet* set = programme.picture ? programme.picture->job.instant->set.get() : nullptr;
    ticks_.add(seen.report.programme.ticks, now);
    repeats_.add(seen.report.programme.repeated, now);
    // The part of the desk's values that the verdict is made of.
    DeskState desk;
    desk.waiting = set == nullptr;
    desk.has_frame_sets = show.settings().take || seen.report.frame_sets_closed > 0;
    desk.signal = seen.report.signal;
    desk.age_s = live_age_s(programme);
    if (show.settings().take) desk.time.emplace().is_of_take = true;
    if (seen.report.signal != SignalState::no_signal) desk.coverage = seen.report.corridor.now;
    desk.tick_rate_hz = ticks_.per_second();
    desk.repeat_rate_hz = repeats_.per_second();
    if (take) {
        desk.take.emplace().failure = take->failure;
        desk.take->trouble = take->trouble;
    }
    desk.computer_worry = memory_worry(memory_pressure());
    for (const RigAccount& account : seen.report.rigs) {
        DeskRig& rig = desk.rigs.emplace_back();
        rig.name = account.status.rig;
        rig.state = state_in(set, account.status);
        const auto last = rigs_seen_.try_emplace(rig.name, now).first;
        if (rig.state == RigState::present) last->second = now;
        rig.absent_s = std::chrono::duration<double>(now - last->second).count();
        rig.worries = worries_of(account.status);
    }
    for (const OutputState& output : seen.report.outputs) {
        DeskOutput& shown = desk.outputs.emplace_back();
        shown.name = output.name;
        shown.is_failed = output.phase == OutputPhase::failed;
    }
    seen.verdict = air_verdict(desk);
    seen.rigs = std::move(desk.rigs);
    seen_ = std::move(seen);
    return true;
}

ControlRoom::ControlRoom(const std::vector<std::string>& urls, LiveShow& show) {
    if (urls.empty()) return;
    ports_.emplace(urls, ControlBench{show.controls().operator_input(), show.controls().tracked(),
                                      tally_, lamps_, ltc_});
}

void ControlRoom::show_lamps(const LiveShow& show, const std::optional<TakeState>& take,
                             const AirVerdict* verdict, const std::string& saved_background,
                             MonotonicTime now) {
    if (!has_lamps()) return;
    const ProgrammeState state = show.state();
    const FlightControls::Lines lines = show.controls().lines();
    ShowLamps& lamps = shown_;
    lamps.live = state.picture && !state.time.is_held && !state.time.pulse;
    lamps.hold = state.time.is_held || (state.time.pulse && state.time.speed == 0);
    lamps.speed = lamps.live ? 1 : state.time.speed;
    lamps.behind_s = state.behind_s.value_or(0);
    lamps.mark_in = state.time.in.has_value();
    lamps.mark_out = state.time.out.has_value();
    lamps.loops = state.time.loops;
    lamps.take = take && take->phase == TakePhase::recording;
    lamps.background = -1;
    for (const RigBackgroundState& background : show.instant_stats().backgrounds)
        lamps.background =
            lamps.background < 0 ? background.known : std::min(lamps.background, background.known);
    lamps.saved_background = saved_background;
    lamps.stage = show.reloads().sentence;
    const Tally::State tally = tally_.state();
    lamps.programme_tally = tally.programme;
    lamps.preview_tally = tally.preview;
    lamps.input_flies_preview = lines.preview.has_value();
    lamps.fly_to_preview = lines.preview ? lines.preview->fly_progress.value_or(-1) : -1;
    lamps.fly_to_preview_s = lines.fly_to_preview_s;
    lamps.tracked = lines.is_tracked;
    lamps.source_map = state.source_map;
    lamps.move = lines.move_progress.value_or(-1);
    lamps.keyframes = static_cast<double>(lines.keyframes);
    lamps.record = lines.is_recording;
    lamps.horizon = lines.holds_horizon;
    lamps.follow = lines.is_following;
    lamps.coverage = lines.corridor.now ? lines.corridor.now->share : -1;
    lamps.wheel_mode = lines.wheel_mode;
    lamps.synthesiser = state.synthesiser;
    lamps.render_level = state.render_level();
    lamps.prepare_level = state.prepare_level();
    lamps.repeated_ticks = static_cast<double>(show.stats().repeated);
    lamps.verdict = verdict ? key_of(verdict->level) : "";
    lamps.fit_for_air = verdict && verdict->level == AirVerdict::Level::ready;
    lamps.verdict_reason = verdict ? verdict->why : "";
    show_replay(state);
    lamps.film = false;
    const std::vector<OutputState> outputs = show.outputs().states();
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (i < lamps.outputs.size()) lamps.outputs[i] = words_of(outputs[i].phase);
        if (!outputs[i].film.empty() && outputs[i].phase == OutputPhase::on) lamps.film = true;
    }
    if (state.picture && now - timecode_shown_ >= timecode_period) {
        timecode_shown_ = now;
        if (!timecodes_)
            timecodes_.emplace(show.settings().pulse_rate_hz, show.settings().pulse_rate_hz);
        lamps.timecode = timecodes_->of(*state.picture->job.instant->set);
    }
    lamps_.put(lamps);
}

void ControlRoom::show_replay(const ProgrammeState& state) {
    // Tenths, so that the lamps change no more often than they can be read.
    const auto tenths = [](const std::optional<double>& seconds) {
        return seconds ? std::round(10 * *seconds) / 10 : -1;
    };
    const auto place = [](const std::optional<std::size_t>& at) {
        return at ? static_cast<double>(*at + 1) : 0;
    };
    const ReplayState& replay = state.replay;
    ShowLamps& lamps = shown_;
    lamps.replay_mode = state.picture ? name_of(replay.mode) : "";
    lamps.clip = replay.hand;
    lamps.played_clip = replay.clip;
    lamps.entry = place(replay.selected);
    lamps.played_entry = place(replay.playing);
    lamps.clip_left_s = tenths(replay.clip_left_s);
    lamps.list_left_s = tenths(replay.list_left_s);
    if (replay.book) {
        lamps.clips = static_cast<double>(replay.book->clips.size());
        lamps.entries = static_cast<double>(replay.book->list.size());
        lamps.preset_percent = std::round(100 * replay.book->programme_speed);
        lamps.list_loops = replay.book->list_loops;
    }
    lamps.programme_speed = replay.is_at_programme_speed;
    lamps.fast_jog = replay.fast_jog;
    lamps.notice = replay.notice;
    lamps.question = replay.question;
    if (!state.picture) return;
    const std::uint64_t pulse = state.picture->job.instant->set->trigger_index;
    lamps.pulse = std::to_string(pulse);
    lamps.at_in = state.time.in == pulse;
    lamps.at_out = state.time.out == pulse;
}

std::vector<PortState> ControlRoom::ports() const {
    return ports_ ? ports_->states() : std::vector<PortState>();
}

std::vector<PortState> ControlRoom::close() {
    if (ports_) ports_->close();
    return ports();
}

}  // namespace vantage
