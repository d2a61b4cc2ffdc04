#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "common/base/command.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time_zone.h"
#include "common/colour/colour_file.h"
#include "common/gl/limits.h"
#include "common/image/image_file.h"
#include "host_app/commands/stereoscopic_options.h"
#include "host_app/desk/operator_window.h"
#include "host_app/live/corridor_watch.h"
#include "host_app/live/live_show.h"
#include "host_app/live/panel_feed.h"
#include "host_app/live/progress_log.h"
#include "host_app/output/picture_target.h"
#include "host_app/takes/take_desk.h"

namespace vantage {
namespace {

struct LiveOptions {
    std::string stage, path, snapshot, film, take, contact_sheet, size, synthesiser, wheels;
    std::string quality = "auto";
    std::uint64_t frames = 0;
    double rate_hz = 0, seconds = 0, wait_s = 10, past_mb = 1024, pre_roll_s = 0;
    bool headless = false, json = false, novelty = false, harmonise = true, overwrite = false;
    bool free_flight = false;
    StereoscopicOptions stereoscopic;
    std::optional<bool> jog;  ///< default: with a window
};

/// "1280x720", each side 16..4096.
cv::Size parse_size(const std::string& text) {
    int width = 0, height = 0, used = 0;
    if (std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) != 2 ||
        static_cast<std::size_t>(used) != text.size() || width < 16 || height < 16 ||
        width > PiLimits::max_image_side_px || height > PiLimits::max_image_side_px)
        fail("--size is WIDTHxHEIGHT with 16 to {} pixels each, such as 1280x720, not '{}'",
             PiLimits::max_image_side_px, text);
    return {width, height};
}

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

LiveSettings live_settings(const LiveOptions& options, const StageConfig& stage) {
    LiveSettings settings{
        .format = {.width_px = stage.view.width_px,
                   .height_px = stage.view.height_px,
                   .stereoscopy = options.stereoscopic.stereoscopy()},
        .rate_hz = options.rate_hz > 0 ? options.rate_hz : stage.rate_hz,
        .pulse_rate_hz = stage.rate_hz,
        .replay_bytes = static_cast<std::size_t>(options.past_mb * 1e6),
        .synthesiser = options.synthesiser.empty() ? stage.view.synthesiser : options.synthesiser,
        .quality = QualityWish::parse(options.quality),
        .source_map = options.novelty,
        .film = options.film,
        .contact_sheet = options.contact_sheet,
        .free_flight = options.free_flight,
        .harmonise = options.harmonise};
    if (!options.size.empty()) {
        const cv::Size size = parse_size(options.size);
        settings.format.width_px = size.width;
        settings.format.height_px = size.height;
    }
    std::error_code ignored;
    if (!settings.film.empty() && !options.overwrite &&
        std::filesystem::exists(settings.film, ignored))
        fail(
            "{} is there already, and a film is not replaced without being asked: take another "
            "name, or --overwrite",
            settings.film.string());
    if (!settings.film.empty() &&
        (settings.format.width_px % 2 != 0 || settings.format.height_px % 2 != 0))
        fail("a film of {}x{} cannot be recorded: its sides have to be even",
             settings.format.width_px, settings.format.height_px);
    (void)find_synthesiser(settings.synthesiser);
    for (const StageConfig::Rig& rig : stage.rigs)
        if (!rig.colour.empty()) settings.colours[rig.name] = load_colour(rig.colour);
    return settings;
}

std::unique_ptr<JogDeck> make_deck(const LiveOptions& options) {
    if (!options.jog.value_or(!options.headless)) return nullptr;
    return std::make_unique<JogDeck>(make_system_jog_bus(), load_wheel_profiles(options.wheels));
}

/// Ends the files, prints the summary, writes the last picture if there was one. Throws Error with
/// the names of outputs that failed.
void finish(const LiveOptions& options, LiveShow& show, const JogDeck* deck, TakeDesk& takes,
            const CorridorWatch& corridor, const std::function<ColourImage()>& last_picture) {
    show.finish();
    takes.finish();
    LiveReport report = show.report();
    if (takes.state().takes > 0) report.take = takes.state();
    report.uncovered = corridor.uncovered_parts();
    if (deck) report.wheels = deck->devices();
    if (options.json)
        std::cout << to_json(report).dump() << '\n';
    else
        std::cout << to_text(report);
    if (report.programme.pictures > 0 && !options.snapshot.empty())
        write_colour_image(options.snapshot, last_picture());
    if (const auto failures = failures_of(report.programme.sinks); !failures.empty())
        fail("the programme went to its end without an output: {}", fmt::join(failures, "; "));
}

void live_headless(const LiveOptions& options, LiveShow& show, const FlightPlan& plan,
                   const JogDeck* deck, TakeDesk& takes, StopSignal& stop) {
    const auto limit = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double>(options.wait_s));
    if (!show.wait_for_rigs(limit, stop)) return;
    // A disk that is too slow is to be known before the first picture.
    while (takes.state().phase == TakePhase::opening &&
           !stop.wait_for(std::chrono::milliseconds(20)))
        ;
    if (takes.state().phase == TakePhase::failed) fail("{}", takes.state().failure);
    show.start();
    ProgressLog progress(plan);
    CorridorWatch corridor(plan);
    while (!show.is_over() && !stop.wait_for(std::chrono::milliseconds(20))) {
        progress.tell(show);
        corridor.tell(show);
    }
    finish(options, show, deck, takes, corridor, [&] {
        const auto last = show.state().picture;
        return last->sources ? last->sources->picture : last->picture;
    });
}

void live_in_window(const LiveOptions& options, LiveShow& show, const FlightPlan& plan,
                    const JogDeck* deck, TakeDesk& takes, StopSignal& stop) {
    // However small the picture, there is room for what an operator reads.
    constexpr double least_width_px = 960;
    const PictureFormat& format = show.settings().format;
    const double larger = std::max(1.0, least_width_px / format.width_px);
    OperatorWindow window("Vantage", cvRound(larger * format.width_px),
                          cvRound(larger * format.height_px));
    show.start();
    PanelFeed panel;
    ProgressLog progress(plan);
    CorridorWatch corridor(plan);
    // Hands are looked at at a rate of its own; the screen is drawn with every new picture, and now
    // and then without one: where the processor draws, it has better things to do.
    constexpr std::chrono::milliseconds period{16}, longest_unchanged{200};
    MonotonicTime last = MonotonicClock::now(), drawn{};
    std::shared_ptr<const MadePicture> shown;
    while (!show.is_over() && !window.closed() &&
           !stop.wait_for(
               std::max(std::chrono::nanoseconds(0), last + period - MonotonicClock::now()))) {
        const MonotonicTime now = MonotonicClock::now();
        const FlightInput input = window.poll(std::chrono::duration<double>(now - last).count());
        if (input.toggle_take) takes.toggle();
        show.controls().hands().put(input, now);
        last = now;
        if (const auto picture = show.state().picture;
            picture != shown || now - drawn > longest_unchanged) {
            shown = picture;
            drawn = now;
            window.show(panel.state(show, takes.state()));
        } else {
            window.leave();
        }
        progress.tell(show);
        corridor.tell(show);
    }
    finish(options, show, deck, takes, corridor, [&] { return window.screenshot(); });
}

void live(const LiveOptions& options) {
    // Before the receiver's threads, so that they leave the signals to it.
    StopSignal stop;
    const StageConfig stage = load_stage_config(options.stage);
    if (!stage.timecode_zone.empty()) use_time_zone(stage.timecode_zone);
    FlightPlan plan;
    if (stage.view.is_placed) plan.start = start_view(stage.view);
    if (!options.path.empty()) plan.move = Move::load(options.path);
    if (options.frames > 0) plan.frames = options.frames;
    if (options.seconds > 0) plan.seconds = options.seconds;
    for (const std::string& picture : {options.snapshot, options.contact_sheet})
        if (!picture.empty()) require_picture_target(picture);
    // A flight that nobody steers ends with its move.
    const bool has_hands = options.jog.value_or(!options.headless);
    if (options.headless && plan.move && !plan.move->loops() && !plan.frames && !plan.seconds &&
        !has_hands)
        plan.seconds = plan.move->duration_s();
    const LiveSettings settings = live_settings(options, stage);
    const std::unique_ptr<JogDeck> deck = make_deck(options);
    TakeDesk takes(stage, options.stage, options.take,
                   std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::duration<double>(options.pre_roll_s)));
    if (!options.take.empty()) takes.begin(options.take);
    StageReceiver receiver(stage, StageReceiver::Purpose::film, takes.tap());
    LiveShow show(settings, plan, takes.feed(feed_of(receiver)), deck.get());
    show.add(takes.camera_sink());
    if (options.headless)
        live_headless(options, show, plan, deck.get(), takes, stop);
    else
        live_in_window(options, show, plan, deck.get(), takes, stop);
}

}  // namespace

CommandEntry live_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<LiveOptions>();
        CLI::App* command = program.add_subcommand(
            "live", "Connect to the rigs of a stage, fuse, fly, put out; ends with a summary");
        command->add_option("--stage", options->stage, "The stage (TOML)")->required();
        command->add_flag("--headless", options->headless, "No window");
        command
            ->add_option("--frames", options->frames,
                         "End after this many pictures (default, without a window: at the end of "
                         "a move that does not loop)")
            ->check(CLI::PositiveNumber);
        command->add_option("--seconds", options->seconds, "End after this time")
            ->check(CLI::Range(0.01, 1e6));
        command->add_option("--path", options->path, "Fly this move (TOML)");
        command->add_option("--snapshot", options->snapshot,
                            "Write the last picture (.png, .jpg); of a window, the panels too");
        command->add_option("--record", options->film,
                            "Write the flight as a film (.mkv, .mp4), with the house's time code");
        command->add_option("--take", options->take,
                            "Record what the rigs send from the start (.mkv; see vantage take); in "
                            "a window the key T ends it and begins another");
        command
            ->add_option("--pre-roll", options->pre_roll_s,
                         "Seconds that a take begun with the key T begins before it")
            ->check(CLI::Range(0.0, 120.0))
            ->capture_default_str();
        command->add_option("--contact-sheet", options->contact_sheet,
                            "Write stills of the flight, with a rig's colour and disparity");
        command->add_flag("--free-flight", options->free_flight,
                          "Let hands fly beyond what the rigs cover; without this the camera is "
                          "slowed towards the end of its corridor and stands there");
        command
            ->add_option("--rate", options->rate_hz,
                         "Pictures a second (default: the stage's rate)")
            ->check(CLI::Range(0.1, 240.0));
        command->add_option("--size", options->size,
                            "Of the picture, WIDTHxHEIGHT (default: the stage's)");
        command->add_option("--synth", options->synthesiser,
                            "Synthesiser (default: the stage's; see render --help)");
        command->add_flag("--overwrite", options->overwrite,
                          "Let --record replace a film that is there");
        command->add_flag_callback(
            "--no-harmonise", [options] { options->harmonise = false; },
            "Leave the rigs' colours as the calibration makes them; without this, small gains take "
            "out slowly what differs where rigs show the same surface");
        command->add_flag(
            "--novelty", options->novelty,
            "Show which rigs the pixels come from, a colour a rig, what none has seen "
            "hatched (key N); on screen and in snapshots, never in films");
        command
            ->add_option("--quality", options->quality,
                         "auto: as good as the ticks allow; best; or a level from 0 (the best) on")
            ->capture_default_str();
        options->stereoscopic.add_to(*command, "the camera's distance from its pivot");
        command
            ->add_option("--wait", options->wait_s,
                         "With --headless: seconds that the rigs may take to come")
            ->check(CLI::Range(0.1, 3600.0))
            ->capture_default_str();
        command
            ->add_option("--past-mb", options->past_mb,
                         "Memory for the newest frames, to go back to them; 0: no way back")
            ->check(CLI::Range(0.0, 1e6))
            ->capture_default_str();
        command->add_flag_callback(
            "--jog", [options] { options->jog = true; },
            "Let jog wheels fly without a window too (with one they do)");
        command->add_flag_callback(
            "--no-jog", [options] { options->jog = false; }, "Leave jog wheels alone");
        command->add_option(
            "--wheels", options->wheels,
            "What the controls of wheels do: a file like those in hw_config/jog, or "
            "a folder of them (TOML)");
        command->add_flag("--json", options->json, "Write the summary as one JSON object");
        command->footer(
            "Without --headless a window opens: fly with mouse and keyboard, F1 helps. The summary "
            "goes to stdout,\nthe log to stderr. Ctrl-C ends in order: files are finished, the "
            "summary is printed. An output that\nfails does not end the programme; the exit status "
            "is 1 then.\n\nWhat the summary's words mean:\n" +
            counters_legend());
        command->callback([options] { live(*options); });
    }};
}

}  // namespace vantage
