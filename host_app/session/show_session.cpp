#include "host_app/session/show_session.h"

#include <iostream>

#include <fmt/ranges.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/trace/trace.h"
#include "common/image/image_file.h"
#include "host_app/control/ports/tracking_sinks.h"
#include "host_app/desk/feed/desk_feed.h"
#include "host_app/desk/feed/stage_map.h"
#include "host_app/desk/windows/operator_window.h"
#include "host_app/desk/windows/screen_windows.h"
#include "host_app/metrics/open_metrics.h"
#include "host_app/output/output_supervisor.h"
#include "host_app/output/picture_sink.h"
#include "host_app/replay/transport.h"
#include "host_app/session/report/show_log.h"

namespace vantage {
void ShowSession::run(StopSignal& stop) {
    const LiveSettings& settings = show.settings();
    for (const std::string& url : options.outputs)
        if (auto sink = make_tracking_sink(url, settings.rate_hz, settings.pulse_rate_hz))
            show.add(std::move(sink));
    BackgroundSaver backgrounds(show, options.saved_background);
    ControlRoom room(options.controls, show);
    if (!options.metrics.empty()) metrics.emplace(options.metrics);
    if (!options.web.empty()) {
        web.emplace(options.web, show.controls().operator_input());
        room.keep_lamps();
    }
    if (options.headless)
        run_headless(stop, room, backgrounds);
    else
        run_in_window(stop, room, backgrounds);
}

/// Ends the files, prints the summary and writes the last picture. Throws Error with the names of
/// the outputs that failed.
void ShowSession::finish(ControlRoom& room, BackgroundSaver& backgrounds,
                         const CorridorWatch& corridor,
                         const std::function<ColourImage()>& last_picture) {
    if (!options.saved_background.empty() && backgrounds.state().path.empty()) backgrounds.save();
    backgrounds.finish();
    show.finish();
    if (takes) takes->finish();
    show.controls().end_recording();
    for (const std::string& wheel : show.controls().wheels().unsaved())
        log_warning("changes to the map of {} were not saved", wheel);
    keep_flights(show.controls().take_requests());
    flights.finish();
    clips.follow(show.state().replay.book, MonotonicClock::now());
    clips.finish();
    LiveReport report = report_now();
    report.saved_background = backgrounds.state().path;
    report.played = played;
    report.ports = room.close();
    report.uncovered = corridor.uncovered_parts();
    if (deck) report.wheels = deck->devices();
    // If frames go to stdout, nothing else may.
    std::ostream& out = show.outputs().takes_stdout() ? std::cerr : std::cout;
    if (options.json)
        out << to_json(report).dump() << '\n';
    else
        out << to_text(report);
    if (report.programme.pictures > 0 && !options.snapshot.empty())
        write_colour_image(options.snapshot, last_picture());
    std::vector<std::string> failures = failures_of(report);
    if (report.take && report.take->phase == TakePhase::failed)
        failures.push_back(report.take->failure);
    if (!backgrounds.state().failure.empty()) failures.push_back(backgrounds.state().failure);
    if (!failures.empty())
        fail("the programme ended, but an output failed: {}", fmt::join(failures, "; "));
}

void ShowSession::keep_flights(const SessionRequests& requests) {
    if (requests.change) flights.keep(*requests.change);
    if (!requests.flight.empty()) flights.simplify(requests.flight, requests.limits);
}

/// Seeks to a time that the operator typed.
void ShowSession::cue_time(const std::string& words) {
    const ProgrammeState state = show.state();
    if (!state.past || !state.picture)
        return log_warning("cannot go to {}: there is no replay buffer", words);
    const std::optional<int> offset_s = tai_offset_s_of(*state.picture->job.instant->set);
    try {
        show.controls().seek(static_cast<double>(pulse_in_past(
            words, *state.past, show.settings().pulse_rate_hz, offset_s.value_or(0))));
    } catch (const Error& error) {
        log_warning("{}", error.what());
    }
}

void ShowSession::follow_replay(MonotonicTime now) {
    const ReplayState replay = show.state().replay;
    clips.follow(replay.book, now);
    if (replay.notices != told_notices) log_warning("{}", replay.notice);
    told_notices = replay.notices;
}

LiveReport ShowSession::report_now() const {
    LiveReport report = show.report();
    report.take = report_take();
    return report;
}

/// The take that is or was recorded; nothing without one.
std::optional<TakeState> ShowSession::report_take() const {
    if (takes && takes->state().takes > 0) return takes->state();
    return std::nullopt;
}

void ShowSession::show_metrics(const ControlRoom& room, MonotonicTime now) {
    // Prometheus reads the metrics a few times a minute.
    constexpr std::chrono::seconds period{1};
    if (!metrics || now - metrics_shown < period) return;
    metrics_shown = now;
    LiveReport report = report_now();
    report.ports = room.ports();
    metrics->show(to_open_metrics(report));
}

/// Moves the pivot to the surface that the operator picked in the picture, or to the performer that
/// it follows.
void ShowSession::find_pivots(const SessionRequests& requests, MonotonicTime now) {
    FlightControls& controls = show.controls();
    const std::vector<FlightControls::Following> following = controls.lines().following;
    const command::PickPivot* pick = nullptr;
    for (const SessionCommand& each : requests.commands)
        if (const auto* found = std::get_if<command::PickPivot>(&each)) pick = found;
    if (!pick && following.empty()) return;
    const ProgrammeState programme = show.state();
    if (!programme.picture) return;
    // The operator picks in the picture of the camera that is flown.
    const MadePicture& seen =
        programme.preview.picture ? *programme.preview.picture : *programme.picture;
    if (pick) {
        const PictureFormat& format = show.settings().format;
        const std::optional<Eigen::Vector3d> point_m =
            surface_at(*seen.job.instant->set, seen.job.camera,
                       static_cast<double>(format.height_px) / format.width_px, pick->place);
        if (point_m)
            controls.operator_input().put({.commands = {command::LookAt{*point_m}}}, now);
        else
            log_info("no rig has a depth there; the pivot stays");
    }
    const FrameSet& set = *programme.picture->job.instant->set;
    if (following.empty() || set.complete == followed) return;
    followed = set.complete;
    for (const auto& [camera, pivot_m] : following)
        if (const auto there_m = foreground_near(set, pivot_m)) controls.follow({camera, *there_m});
}

/// Carries out the operator's requests that the programme does not handle itself.
void ShowSession::follow_requests(OutputSwitch& outputs, BackgroundSaver& backgrounds,
                                  ControlRoom& room, MonotonicTime now) {
    const SessionRequests requests = show.controls().take_requests();
    keep_flights(requests);
    find_pivots(requests, now);
    follow_replay(now);
    if (std::optional<Move> move = flights.follow(now))
        show.controls().keep_flight(*std::move(move));
    for (const SessionCommand& each : requests.commands) {
        if (const auto* cue = std::get_if<command::CueTime>(&each)) cue_time(cue->time);
        if (const auto* output = std::get_if<command::ToggleOutput>(&each))
            outputs.press(output->number, now);
        if (takes && std::holds_alternative<command::ToggleTake>(each)) takes->toggle();
        if (std::holds_alternative<command::LearnBackground>(each)) show.learn_background_anew();
        if (std::holds_alternative<command::SaveBackground>(each)) backgrounds.save();
        if (std::holds_alternative<command::ReloadStage>(each)) {
            if (stage)
                stage->reload();
            else
                log_warning("a take is shown: there is no stage file to reload");
        }
    }
    if (stage && hang_up) stage->follow(*hang_up);
    show_metrics(room, now);
    const bool is_new = room.has_lamps() && air.follow(show, report_take(), now);
    room.show_lamps(show, takes ? std::optional(takes->state()) : std::nullopt,
                    air.seen() ? &air.seen()->verdict : nullptr, backgrounds.state().path, now);
    if (web) web->follow(show, *air.seen(), is_new, report_take(), room.lamps());
}

void ShowSession::run_headless(StopSignal& stop, ControlRoom& room, BackgroundSaver& backgrounds) {
    // The page names the rigs that are waited for.
    const auto show_page = [&] {
        const MonotonicTime now = MonotonicClock::now();
        if (web && air.follow(show, report_take(), now))
            web->follow(show, *air.seen(), true, report_take(), room.lamps());
    };
    if (!wait(stop, show_page)) return;
    // A take that cannot be written must fail before the first picture.
    while (takes && takes->state().phase == TakePhase::opening &&
           !stop.wait_for(std::chrono::milliseconds(20)))
        ;
    if (takes && takes->state().phase == TakePhase::failed) fail("{}", takes->state().failure);
    show.start();
    ProgressLog progress(plan);
    CorridorWatch corridor(plan);
    ComputerWatch computer;
    OutputSwitch outputs(show.outputs());
    ScreenWindows screens(false);
    const std::chrono::milliseconds look(show.outputs().screens().empty() ? 20 : 4);
    while (!show.is_over() && !stop.wait_for(look)) {
        follow_requests(outputs, backgrounds, room, MonotonicClock::now());
        screens.follow(show.outputs().screens());
        progress.tell(show);
        corridor.tell(show);
        computer.tell();
    }
    finish(room, backgrounds, corridor, [&] {
        const auto last = show.state().picture;
        return last->sources ? last->sources->picture : last->picture;
    });
}

void ShowSession::run_in_window(StopSignal& stop, ControlRoom& room, BackgroundSaver& backgrounds) {
    // The desk needs this room even around a small picture.
    constexpr int min_width_px = 1280, min_height_px = 720;
    const PictureFormat& format = show.settings().format;
    OperatorWindow window("Vantage", std::max(min_width_px, format.width_px),
                          std::max(min_height_px, format.height_px));
    if (desk) window.arrange(desk->desk());
    show.controls().wheels().serve_desk();
    show.start();
    DeskFeed feed;
    ProgressLog progress(plan);
    CorridorWatch corridor(plan);
    ComputerWatch computer;
    OutputSwitch outputs(show.outputs());
    ScreenWindows screens(true);
    // Input is read 60 times a second and pictures are shown as they come. The rest of the desk is
    // drawn less often, since a software renderer needs the time for the programme.
    constexpr std::chrono::milliseconds period{16};
    MonotonicTime last = MonotonicClock::now();
    std::shared_ptr<const MadePicture> shown, shown_preview;
    while (!show.is_over() && !window.closed() &&
           !stop.wait_for(
               std::max(std::chrono::nanoseconds(0), last + period - MonotonicClock::now()))) {
        const MonotonicTime now = MonotonicClock::now();
        TraceSpan polling("window events");
        const FlightInput input = window.poll(std::chrono::duration<double>(now - last).count());
        polling.end();
        if (const std::optional<double> pulse = window.take_seek()) show.controls().seek(*pulse);
        for (const WheelCall& call : window.take_wheel_calls()) show.controls().wheels().obey(call);
        show.controls().operator_input().put(input, now);
        TraceSpan following("requests");
        follow_requests(outputs, backgrounds, room, now);
        screens.follow(show.outputs().screens());
        following.end();
        last = now;
        const ProgrammeState programme = show.state();
        const bool is_new = programme.picture != shown;
        if (window.is_desk_due(now) || (is_new && !shown)) {
            const TraceSpan span("desk");
            DeskState state =
                feed.state(show, programme, takes ? std::optional(takes->state()) : std::nullopt,
                           outputs.question(now), window.shows_outside());
            state.programme_tally = room.tally().programme;
            state.preview_tally = room.tally().preview;
            state.programme_monitors = screens.monitors();
            const LtcBoard::State ltc = room.ltc();
            state.is_ltc_off = ltc.frames_ahead != 0;
            state.ltc =
                ltc.code.empty()
                    ? ""
                    : fmt::format(
                          "LTC {}{}", ltc.code,
                          state.is_ltc_off ? fmt::format(" ({:+} frames)", ltc.frames_ahead) : "");
            window.show(std::move(state));
        } else if (is_new || (shown && programme.preview.picture != shown_preview)) {
            const TraceSpan span("desk pictures");
            window.show_pictures(*feed.picture(programme), feed.preview(programme));
        }
        if (is_new) feed.note_shown(programme);
        shown = programme.picture;
        shown_preview = programme.preview.picture;
        if (desk) desk->follow(window.arrangement(), now);
        progress.tell(show);
        corridor.tell(show);
        computer.tell();
    }
    if (desk) desk->finish();
    finish(room, backgrounds, corridor, [&] { return window.screenshot(); });
}

}  // namespace vantage
