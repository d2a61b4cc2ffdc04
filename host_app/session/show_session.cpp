#include "host_app/session/show_session.h"

#include <iostream>
#include <numbers>

#include <fmt/ranges.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"
#include "common/image/image_file.h"
#include "host_app/background/background_file.h"
#include "host_app/control/ports/freed_sink.h"
#include "host_app/desk/feed/desk_feed.h"
#include "host_app/desk/feed/surface_pick.h"
#include "host_app/desk/windows/operator_window.h"
#include "host_app/desk/windows/screen_windows.h"
#include "host_app/metrics/open_metrics.h"
#include "host_app/output/media/picture_encoder.h"
#include "host_app/output/picture_target.h"
#include "host_app/output/frame_set_timecode.h"
#include "host_app/replay/past_time.h"
#include "host_app/session/corridor_watch.h"
#include "host_app/session/options/help_words.h"
#include "host_app/session/options/picture_options.h"
#include "host_app/session/output_switch.h"
#include "host_app/session/report/progress_log.h"

namespace vantage {
namespace {

OrbitView start_view(const StageConfig::View& view) {
    constexpr double rad = std::numbers::pi / 180;
    OrbitView start;
    start.pivot_m = {view.target_m[0], view.target_m[1], view.target_m[2]};
    start.azimuth_rad = view.azimuth_deg * rad;
    start.elevation_rad = view.elevation_deg * rad;
    start.distance_m = view.distance_m;
    start.field_of_view_rad = view.field_of_view_deg * rad;
    return start;
}

}  // namespace

LiveSettings ShowOptions::settings(const StageConfig::View& view, double pulse_rate_hz) const {
    LiveSettings settings{
        .format = {.width_px = view.width_px,
                   .height_px = view.height_px,
                   .stereoscopy = stereoscopic.stereoscopy()},
        .rate_hz = PulseGrid(rate.empty() ? pulse_rate_hz : parse_rate(rate)).rate_hz(),
        .pulse_rate_hz = pulse_rate_hz,
        .synthesiser = synthesiser.empty() ? view.synthesiser : synthesiser,
        .quality = QualityRequest::parse(quality),
        .source_map = source_map,
        .outputs = {},
        .encoder = encoder,
        .overwrites = overwrite,
        .contact_sheet = contact_sheet,
        .free_flight = free_flight,
        .compensate_gains = compensate_gains};
    if (!set.empty()) settings.set = std::make_shared<const Background>(load_background(set));
    if (!size.empty()) {
        const cv::Size wanted = parse_size(size);
        settings.format.width_px = wanted.width;
        settings.format.height_px = wanted.height;
    }
    for (const std::string& url : outputs)
        if (is_freed_url(url))
            (void)make_freed_sink(url);
        else
            settings.outputs.push_back(url);
    if (!film.empty()) settings.outputs.insert(settings.outputs.begin(), "file:" + film);
    OutputSupervisor::check(output_settings(settings));
    (void)find_synthesiser(settings.synthesiser);
    return settings;
}

std::shared_ptr<PictureSound> ShowOptions::sound(double rate_hz, const SoundTap& tap,
                                                 std::shared_ptr<SoundSource> source) const {
    if (!audio.empty()) source = open_sound(audio, tap);
    if (!source) {
        if (audio_delay_ms)
            fail(
                "--audio-delay says nothing without a sound: say --audio, or play a take with one");
        return nullptr;
    }
    PictureSound::Settings settings{.rate_hz = rate_hz, .tap = tap};
    if (audio_delay_ms) settings.delay = from_s(*audio_delay_ms / 1000);
    return std::make_shared<PictureSound>(settings, std::move(source));
}

FlightStore ShowOptions::flight_store(const std::string& beside) const {
    return FlightStore(flight.empty() ? flight_file_of(beside) : std::filesystem::path(flight));
}

ClipStore ShowOptions::clip_store(const std::string& beside, double pulse_rate_hz) const {
    return {clips.empty() ? clip_file_of(beside) : std::filesystem::path(clips), pulse_rate_hz};
}

std::optional<DeskStore> ShowOptions::desk_store(const std::string& beside) const {
    if (headless) return std::nullopt;
    return DeskStore(desk.empty() ? desk_file_of(beside) : std::filesystem::path(desk));
}

FlightPlan ShowOptions::plan(const StageConfig::View& view, FlightStore& flights) const {
    FlightPlan plan;
    plan.book = flights.book();
    if (view.is_placed) plan.start = start_view(view);
    if (!path.empty()) {
        FlightBook asked = load_flight(path);
        plan.move = std::move(asked.move);
        if (plan.move) flights.begin_with_another_move();
        for (std::size_t i = 0; i < asked.shots.size(); ++i)
            if (asked.shots[i]) plan.book.shots[i] = std::move(asked.shots[i]);
    }
    if (frames > 0) plan.frames = frames;
    if (seconds > 0) plan.seconds = seconds;
    for (const std::string& picture : {snapshot, contact_sheet})
        if (!picture.empty()) require_picture_target(picture, overwrite);
    return plan;
}

std::unique_ptr<JogDevices> ShowOptions::make_deck() const {
    if (!jog.value_or(!headless)) return nullptr;
    return std::make_unique<JogDevices>(make_system_jog_bus(), load_all_wheel_profiles(wheels));
}

void ShowOptions::add_to(CLI::App& command, const std::string& default_rate) {
    command.add_flag("--headless", headless, "No window");
    command
        .add_option("--frames", frames,
                    "End after this many pictures (default, without a window: at the end of a move "
                    "that does not loop)")
        ->check(CLI::PositiveNumber);
    command.add_option("--seconds", seconds, "End after this time")->check(CLI::Range(0.01, 1e6));
    command.add_option("--path", path,
                       "Fly the move of this flight file (TOML), and have its shots");
    command.add_option(
        "--flight", flight,
        "Keep shots and move in this flight file, and have them from there (default: "
        "NAME.flight.toml beside the stage or the take)");
    command.add_option("--clips", clips,
                       "Keep clips and play list in this file, and have them from there (default: "
                       "NAME.clips.toml beside the stage or the take)");
    command.add_option("--desk", desk,
                       "Keep how the desk is arranged in this file, and have it from there "
                       "(default: NAME.desk.toml beside the stage or the take)");
    command.add_option("--snapshot", snapshot,
                       "Write the last picture (.png, .jpg); of a window, the whole desk");
    std::string kinds;
    for (const OutputEntry& entry : output_entries()) kinds += "\n  " + entry.words;
    kinds += "\n  freed://HOST:PORT (the camera of every tick as FreeD D1; ?camera=1)";
    command
        .add_option(
            "--output", outputs,
            "Put the programme out, clean and at its constant rate; any number of these:" + kinds)
        ->type_name("URL")
        ->allow_extra_args(false);
    std::string ports;
    for (const PortEntry& entry : port_entries()) ports += "\n  " + entry.words;
    command
        .add_option("--control", controls,
                    "Let others steer (docs/control.md; vantage control lists what they may ask "
                    "for); any number of these, at this computer only without open=yes:" +
                        ports)
        ->type_name("URL")
        ->allow_extra_args(false);
    command
        .add_option(
            "--metrics", metrics,
            "Tell Prometheus how the show stands, at http://HOST:PORT/metrics (:9464 listens "
            "at 127.0.0.1; ?open=yes)")
        ->type_name("URL");
    command
        .add_option("--audio", audio,
                    "Sound that goes with the programme (docs/sound.md): alsa:DEVICE "
                    "(?channels=3,4) or a file (?loop=yes)")
        ->type_name("SOURCE");
    command
        .add_option("--audio-delay", audio_delay_ms,
                    "Milliseconds from when it is heard to when it leaves (default: as long as "
                    "pictures take from exposure, measured; of a file none)")
        ->check(CLI::Range(0.0, 10'000.0));
    command.add_option("--record", film,
                       "Write the programme as a film (.mkv, .mp4), with the house's time code: "
                       "--output of a file");
    command.add_option("--set", set,
                       "Begin with this set, which was learnt before (.vset): rigs whose "
                       "calibration is another learn theirs anew");
    command.add_option("--save-set", saved_background,
                       "Save what was learnt of the set here at the end, or with the key J; "
                       "without this the key names the file for the time");
    command.add_option("--encoder", encoder,
                       fmt::format("Encode with this one of {}; without it the first that works is "
                                   "taken, and named in the log",
                                   fmt::join(known_encoders(), ", ")));
    command.add_option("--contact-sheet", contact_sheet,
                       "Write stills of the flight, with a rig's colour and disparity");
    command.add_flag("--free-flight", free_flight,
                     "Let hands fly beyond what the rigs cover; without this the camera is slowed "
                     "towards the end of its corridor and stands there");
    command.add_option(
        "--rate", rate,
        "Pictures a second, such as 50, 29.97 or 30000/1001 (default: " + default_rate + " rate)");
    command.add_option("--size", size,
                       "Of the picture, WIDTHxHEIGHT (default: " + default_rate + ")");
    command
        .add_option("--synth", synthesiser,
                    "Synthesiser (default: " + default_rate + "; see render --help)")
        ->type_name(synthesisers_type_name());
    command.add_flag("--overwrite", overwrite,
                     "Let films and pictures replace files that are there");
    command.add_flag_callback(
        "--no-harmonise", [this] { compensate_gains = false; },
        "Leave the rigs' colours as the calibration makes them; without this, small gains take out "
        "slowly what differs where rigs show the same surface");
    command.add_flag("--novelty", source_map,
                     "Show which rigs the pixels come from, a colour a rig, what none has seen "
                     "hatched (key N); on screen and in snapshots, never in films");
    command
        .add_option("--quality", quality,
                    "auto: as good as the ticks allow; best; or a level from 0 (the best) on")
        ->capture_default_str();
    stereoscopic.add_to(command, "the camera's distance from its pivot");
    command.add_flag_callback(
        "--jog", [this] { jog = true; },
        "Let jog wheels fly without a window too (with one they do)");
    command.add_flag_callback(
        "--no-jog", [this] { jog = false; }, "Leave jog wheels alone");
    command.add_option("--wheels", wheels,
                       fmt::format("What the controls of wheels do: {}", wheel_files_help));
    command.add_flag("--json", json, "Write the summary as one JSON object");
}

void ShowSession::run(StopSignal& stop) {
    for (const std::string& url : options.outputs)
        if (is_freed_url(url)) show.add(make_freed_sink(url));
    BackgroundSaver sets(show, options.saved_background);
    ControlRoom room(options.controls, show);
    if (!options.metrics.empty()) metrics.emplace(options.metrics);
    if (options.headless)
        run_headless(stop, room, sets);
    else
        run_in_window(stop, room, sets);
}

/// Ends the files, prints the summary, writes the last picture if there was one. Throws Error with
/// the names of outputs that failed, a take among them.
void ShowSession::finish(ControlRoom& room, BackgroundSaver& sets, const CorridorWatch& corridor,
                         const std::function<ColourImage()>& last_picture) {
    if (!options.saved_background.empty() && sets.state().path.empty()) sets.save();
    sets.finish();
    show.finish();
    if (takes) takes->finish();
    show.controls().end_recording();
    for (const std::string& wheel : show.controls().wheels().unsaved())
        log_warning("the map of {} was changed and not saved: it is gone", wheel);
    keep_flights(show.controls().take_requests());
    flights.finish();
    clips.follow(show.state().replay.book, MonotonicClock::now());
    clips.finish();
    LiveReport report = report_now();
    report.saved_background = sets.state().path;
    report.played = played;
    report.ports = room.close();
    report.uncovered = corridor.uncovered_parts();
    if (deck) report.wheels = deck->devices();
    // Where pictures went to the standard output, nothing else may.
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
    if (!sets.state().failure.empty()) failures.push_back(sets.state().failure);
    if (!failures.empty())
        fail("the programme went to its end without an output: {}", fmt::join(failures, "; "));
}

void ShowSession::keep_flights(const SessionRequests& requests) {
    if (requests.change) flights.keep(*requests.change);
    if (!requests.flight.empty()) flights.simplify(requests.flight, requests.limits);
}

/// To a time that somebody has typed.
void ShowSession::cue_time(const std::string& words) {
    const ProgrammeState state = show.state();
    if (!state.past || !state.picture) return log_warning("there is no past to go to {} in", words);
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
    if (takes && takes->state().takes > 0) report.take = takes->state();
    return report;
}

void ShowSession::show_metrics(const ControlRoom& room, MonotonicTime now) {
    // Prometheus looks a few times a minute.
    constexpr std::chrono::seconds period{1};
    if (!metrics || now - metrics_shown < period) return;
    metrics_shown = now;
    LiveReport report = report_now();
    report.ports = room.ports();
    metrics->show(to_open_metrics(report));
}

/// Finds surfaces for hands that name them by a place in the picture, and the performer whom the
/// pivot goes with.
void ShowSession::find_pivots(const SessionRequests& requests, MonotonicTime now) {
    FlightControls& controls = show.controls();
    const std::vector<FlightControls::Following> following = controls.lines().following;
    if (!requests.pick && following.empty()) return;
    const ProgrammeState programme = show.state();
    if (!programme.picture) return;
    // Hands pick in the picture of the camera that they fly.
    const MadePicture& seen =
        programme.preview.picture ? *programme.preview.picture : *programme.picture;
    if (requests.pick) {
        const PictureFormat& format = show.settings().format;
        FlightInput input;
        input.pivot_m =
            surface_at(*seen.job.instant->set, seen.job.camera,
                       static_cast<double>(format.height_px) / format.width_px, *requests.pick);
        if (input.pivot_m)
            controls.operator_input().put(input, now);
        else
            log_info("no rig has a depth there: the pivot stays");
    }
    const FrameSet& set = *programme.picture->job.instant->set;
    if (following.empty() || set.complete == followed) return;
    followed = set.complete;
    for (const auto& [camera, pivot_m] : following)
        if (const auto there_m = foreground_near(set, pivot_m)) controls.follow({camera, *there_m});
}

/// What hands asked for beyond the programme itself.
void ShowSession::follow_requests(OutputSwitch& outputs, BackgroundSaver& sets, ControlRoom& room,
                                MonotonicTime now) {
    const SessionRequests requests = show.controls().take_requests();
    keep_flights(requests);
    find_pivots(requests, now);
    if (!requests.cue_time.empty()) cue_time(requests.cue_time);
    follow_replay(now);
    if (std::optional<Move> move = flights.follow(now))
        show.controls().keep_flight(*std::move(move));
    if (takes && requests.toggle_take) takes->toggle();
    for (const int number : requests.outputs) outputs.press(number, now);
    if (requests.learn_background) show.learn_background_anew();
    if (requests.save_background) sets.save();
    show_metrics(room, now);
    room.show_lamps(show, takes ? std::optional(takes->state()) : std::nullopt, sets.state().path,
                    now);
}

void ShowSession::run_headless(StopSignal& stop, ControlRoom& room, BackgroundSaver& sets) {
    if (!wait(stop)) return;
    // A disk that is too slow is to be known before the first picture.
    while (takes && takes->state().phase == TakePhase::opening &&
           !stop.wait_for(std::chrono::milliseconds(20)))
        ;
    if (takes && takes->state().phase == TakePhase::failed) fail("{}", takes->state().failure);
    show.start();
    ProgressLog progress(plan);
    CorridorWatch corridor(plan);
    OutputSwitch outputs(show.outputs());
    ScreenWindows screens(false);
    const std::chrono::milliseconds look(show.outputs().screens().empty() ? 20 : 4);
    while (!show.is_over() && !stop.wait_for(look)) {
        follow_requests(outputs, sets, room, MonotonicClock::now());
        screens.follow(show.outputs().screens());
        progress.tell(show);
        corridor.tell(show);
    }
    finish(room, sets, corridor, [&] {
        const auto last = show.state().picture;
        return last->sources ? last->sources->picture : last->picture;
    });
}

void ShowSession::run_in_window(StopSignal& stop, ControlRoom& room, BackgroundSaver& sets) {
    // Room for the desk around the picture, whatever the picture's size.
    constexpr int least_width_px = 1280, least_height_px = 720;
    const PictureFormat& format = show.settings().format;
    OperatorWindow window("Vantage", std::max(least_width_px, format.width_px),
                          std::max(least_height_px, format.height_px));
    if (desk) window.arrange(desk->desk());
    show.controls().wheels().serve_desk();
    show.start();
    DeskFeed feed;
    ProgressLog progress(plan);
    CorridorWatch corridor(plan);
    OutputSwitch outputs(show.outputs());
    ScreenWindows screens(true);
    // Hands are looked at at a rate of its own, pictures are shown as they come, and the rest of
    // the desk is drawn now and then: where the processor draws, it has better things to do.
    constexpr std::chrono::milliseconds period{16};
    MonotonicTime last = MonotonicClock::now();
    std::shared_ptr<const MadePicture> shown, shown_preview;
    while (!show.is_over() && !window.closed() &&
           !stop.wait_for(
               std::max(std::chrono::nanoseconds(0), last + period - MonotonicClock::now()))) {
        const MonotonicTime now = MonotonicClock::now();
        const FlightInput input = window.poll(std::chrono::duration<double>(now - last).count());
        if (const std::optional<double> pulse = window.take_seek()) show.controls().seek(*pulse);
        for (const WheelCall& call : window.take_wheel_calls()) show.controls().wheels().obey(call);
        follow_requests(outputs, sets, room, now);
        screens.follow(show.outputs().screens());
        show.controls().operator_input().put(input, now);
        last = now;
        const ProgrammeState programme = show.state();
        const bool is_new = programme.picture != shown;
        if (window.is_desk_due(now) || (is_new && !shown)) {
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
            window.show_pictures(*feed.picture(programme), feed.preview(programme));
        }
        if (is_new) feed.note_shown(programme);
        shown = programme.picture;
        shown_preview = programme.preview.picture;
        if (desk) desk->follow(window.arrangement(), now);
        progress.tell(show);
        corridor.tell(show);
    }
    if (desk) desk->finish();
    finish(room, sets, corridor, [&] { return window.screenshot(); });
}

}  // namespace vantage
