#include <memory>
#include <numbers>
#include <string>

#include <CLI/CLI.hpp>

#include "common/base/command.h"
#include "common/base/log.h"
#include "common/base/time_zone.h"
#include "common/colour/colour_file.h"
#include "host_app/commands/show_session.h"

namespace vantage {
namespace {

struct LiveOptions {
    ShowOptions show;
    std::string stage, take, takes;
    double wait_s = 10, past_mb = 1024, pre_roll_s = 0;
};

std::chrono::nanoseconds as_duration(double seconds) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double>(seconds));
}

FlightHabits habits_of(const StageConfig::Flight& flight) {
    constexpr double rad = std::numbers::pi / 180;
    FlightHabits habits;
    habits.holds_horizon = flight.holds_horizon;
    habits.shot_s = flight.shot_s;
    habits.keyframe_gap_s = flight.keyframe_s;
    habits.max_turn_rad_s = rad * flight.max_turn_deg_s;
    habits.max_zoom_rad_s = rad * flight.max_zoom_deg_s;
    habits.max_speed_m_s = flight.max_speed_m_s;
    habits.ramp_s = flight.ramp_s;
    habits.follow_s = flight.smoothing_s;
    return habits;
}

void live(const LiveOptions& options) {
    // Before the receiver's threads, so that they leave the signals to it.
    StopSignal stop;
    const StageConfig stage = load_stage_config(options.stage);
    if (!stage.timecode_zone.empty()) use_time_zone(stage.timecode_zone);
    FlightStore flights = options.show.flight_store(options.stage);
    FlightPlan plan = options.show.plan(stage.view, flights);
    plan.habits = habits_of(stage.flight);
    if (plan.move && plan.move->take_s_at(0))
        log_warning(
            "{} says where in a take the camera is when; that is left aside, since the stage "
            "is live",
            options.show.path);
    // A flight that nobody steers ends with its move.
    const bool has_hands = options.show.jog.value_or(!options.show.headless);
    if (options.show.headless && plan.move && !plan.move->loops() && !plan.frames &&
        !plan.seconds && !has_hands)
        plan.seconds = plan.move->duration_s();
    LiveSettings settings = options.show.settings(stage.view, stage.rate_hz);
    settings.replay_bytes = static_cast<std::size_t>(options.past_mb * 1e6);
    for (const StageConfig::Rig& rig : stage.rigs)
        if (!rig.colour.empty()) settings.colours[rig.name] = load_colour(rig.colour);
    const std::unique_ptr<JogDeck> deck = options.show.make_deck();
    TakeDesk takes(stage, options.stage, options.take, options.takes,
                   as_duration(options.pre_roll_s));
    if (!options.take.empty()) takes.begin(options.take);
    StageReceiver receiver(stage, StageReceiver::Purpose::film, takes.tap());
    LiveShow show(settings, plan, takes.feed(feed_of(receiver)), deck.get());
    show.add(takes.camera_sink());
    ShowSession session{
        options.show, show, plan, deck.get(), flights, &takes, "", [&](StopSignal& signal) {
            return show.wait_for_rigs(as_duration(options.wait_s), signal);
        }};
    session.run(stop);
}

}  // namespace

CommandEntry live_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<LiveOptions>();
        CLI::App* command = program.add_subcommand(
            "live", "Connect to the rigs of a stage, fuse, fly, put out; ends with a summary");
        command->add_option("--stage", options->stage, "The stage (TOML)")->required();
        options->show.add_to(*command, "the stage's");
        CLI::Option* take = command->add_option(
            "--take", options->take,
            "Record what the rigs send from the start (.mkv; see vantage take); in "
            "a window the key T ends it and begins another");
        command
            ->add_option("--takes", options->takes,
                         "Folder of the takes that the key T begins, named for the time (default: "
                         "where the program was started)")
            ->excludes(take);
        command
            ->add_option("--pre-roll", options->pre_roll_s,
                         "Seconds that a take begun with the key T begins before it")
            ->check(CLI::Range(0.0, 120.0))
            ->capture_default_str();
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
