#include "host_app/commands/live_session.h"

#include <memory>

#include "common/base/log.h"
#include "common/base/time/time.h"
#include "common/base/time/time_zone.h"
#include "common/colour/colour_file.h"
#include "host_app/takes/stage_habits.h"

namespace vantage {
void run_live_session(const LiveOptions& options) {
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
    const std::unique_ptr<JogDevices> deck = options.show.make_deck();
    TakeControl takes(stage, options.stage, options.take, options.takes, from_s(options.pre_roll_s),
                   !options.show.audio.empty());
    if (!options.take.empty()) takes.begin(options.take);
    // Ends before the takes that its sound goes to.
    LiveSettings heard = settings;
    heard.sound = options.show.sound(settings.rate_hz, takes.sound_tap());
    StageReceiver receiver(stage, StageReceiver::Purpose::film, takes.tap());
    LiveShow show(heard, plan, takes.feed(feed_of(receiver)), deck.get());
    show.add(takes.camera_sink());
    ShowSession session{
        options.show,
        show,
        plan,
        deck.get(),
        flights,
        clips,
        options.show.desk_store(options.stage),
        &takes,
        "",
        [&](StopSignal& signal) { return show.wait_for_rigs(from_s(options.wait_s), signal,
                                                              options.while_waiting); }};
    session.run(stop);
}

}  // namespace vantage
