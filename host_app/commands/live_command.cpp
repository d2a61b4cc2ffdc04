#include <memory>

#include <CLI/CLI.hpp>

#include "common/base/cli/command.h"
#include "common/base/log.h"
#include "common/base/time/time.h"
#include "common/base/time/time_zone.h"
#include "common/colour/colour_file.h"
#include "host_app/commands/live_session.h"
#include "host_app/session/options/common_options.h"
#include "host_app/takes/take_show.h"

namespace vantage {

void run_live_session(const LiveOptions& options) {
    // They must exist before the receiver's threads, so that they receive the signals.
    StopSignal stop;
    ReloadSignal hang_up;
    const StageConfig stage = load_stage_config(options.stage);
    if (!stage.timecode_zone.empty()) use_time_zone(stage.timecode_zone);
    FlightStore flights = options.show.flight_store(options.stage);
    FlightPlan plan = options.show.plan(stage.view, flights);
    plan.habits = habits_of(stage.flight);
    if (plan.move && plan.move->take_s_at(0))
        log_warning(
            "{} is tied to the time of a take; its times in the take are ignored because the stage "
            "is live",
            options.show.path);
    // A flight without operator input ends with its move.
    const bool has_operator_input = options.show.jog.value_or(!options.show.headless);
    if (options.show.headless && plan.move && !plan.move->loops() && !plan.frames &&
        !plan.seconds && !has_operator_input)
        plan.seconds = plan.move->duration_s();
    LiveSettings settings = options.show.settings(stage.view, stage.rate_hz);
    ClipStore clips = options.show.clip_store(options.stage, stage.rate_hz);
    settings.replay = Replay(Transport(), clips.book());
    settings.sync_proof = sync_proof_of(options.stage);
    settings.replay_bytes = static_cast<std::size_t>(options.past_mb * 1e6);
    for (const StageConfig::Rig& rig : stage.rigs)
        if (!rig.colour.empty()) settings.colours[rig.name] = load_colour(rig.colour);
    // It must exist before the threads that it records.
    const std::unique_ptr<TraceFile> trace = options.show.make_trace("vantage live");
    const std::unique_ptr<JogDevices> deck = options.show.make_deck();
    TakeControl takes(stage, options.stage, options.take, options.takes, from_s(options.pre_roll_s),
                      !options.show.audio.empty());
    if (!options.take.empty()) takes.begin(options.take);
    // The sound writes into the takes, so it must be destroyed before them.
    LiveSettings with_sound = settings;
    with_sound.sound = options.show.sound(settings.rate_hz, takes.sound_tap());
    StageReceiver receiver(stage, StageReceiver::Purpose::film, takes.tap());
    LiveShow show(with_sound, plan, takes.feed(feed_of(receiver)), deck.get());
    show.add(takes.camera_sink());
    ShowSession session{options.show,
                        show,
                        plan,
                        deck.get(),
                        flights,
                        clips,
                        options.show.desk_store(options.stage),
                        &takes,
                        "",
                        [&](StopSignal& signal, const std::function<void()>& while_waiting) {
                            return show.wait_for_rigs(from_s(options.wait_s), signal, [&] {
                                while_waiting();
                                if (options.while_waiting) options.while_waiting();
                            });
                        }};
    StageReload reload(options.stage, stage, receiver, takes, show);
    session.stage = &reload;
    session.hang_up = &hang_up;
    session.run(stop);
}

CommandEntry live_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<LiveOptions>();
        CLI::App* command = program.add_subcommand(
            "live",
            "Show a stage live: receive its rigs, fly the virtual camera, send the programme");
        namespace group = option_group;
        command->add_option("--stage", options->stage, stage_file_help)
            ->required()
            ->group(group::input);
        command
            ->add_option("--wait", options->wait_s,
                         "With --headless: wait at most this many seconds for the rigs, and up to "
                         "five minutes more while one reports that it is starting")
            ->check(CLI::Range(0.1, 3600.0))
            ->capture_default_str()
            ->group(group::input);
        options->show.add_to(*command, "the stage's");
        CLI::Option* take =
            command
                ->add_option("--take", options->take,
                             "Record the rigs' frames to this take (.mkv) from the start (see "
                             "vantage take); the key T ends it and starts another")
                ->group(group::recording);
        command
            ->add_option("--takes", options->takes,
                         "Put takes started with the key T into this folder, named by the time "
                         "(default: the working folder)")
            ->excludes(take)
            ->group(group::recording);
        command
            ->add_option("--pre-roll", options->pre_roll_s,
                         "Start a take this many seconds before the key T")
            ->check(CLI::Range(0.0, 120.0))
            ->capture_default_str()
            ->group(group::recording);
        command
            ->add_option("--past-mb", options->past_mb,
                         "Set the size of the replay buffer in MB; 0: no replay")
            ->check(CLI::Range(0.0, 1e6))
            ->capture_default_str()
            ->group(group::recording);
        command->footer(
            "Without --headless a window opens. Fly with mouse and keyboard; F1 shows the keys. "
            "The summary goes to\nstdout, the log to stderr. Ctrl-C finishes the files and prints "
            "the summary. If an output fails, the\nprogramme continues, and the exit status is "
            "1.\n\nHeadings of the summary:\n" +
            counters_legend());
        command->callback([options] { run_live_session(*options); });
    }};
}

}  // namespace vantage
