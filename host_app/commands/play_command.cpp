#include <cmath>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time_zone.h"
#include "host_app/session/options/common_options.h"
#include "host_app/session/show_session.h"
#include "host_app/sound/sound_source.h"
#include "host_app/takes/take_frame_sets.h"
#include "host_app/takes/take_show.h"

namespace vantage {
namespace {

struct PlayOptions {
    ShowOptions show;
    std::string take, from, to;
    double speed = 1;
    bool loops = false;
};

Transport transport_of(const PlayOptions& options, const TakeReader& take,
                       const PastFrameSets::Span& span) {
    std::optional<std::uint64_t> in, out;
    if (!options.from.empty()) in = pulse_of(take, options.from, span.oldest, span.newest);
    if (!options.to.empty()) out = pulse_of(take, options.to, span.oldest, span.newest);
    if (in && *in > span.newest)
        fail("--from {} is after the end of {}", options.from, options.take);
    if (in.value_or(span.oldest) >= out.value_or(span.newest + 1))
        fail("--from {} is not before --to {}", options.from, options.to);
    const std::uint64_t last = std::min(out.value_or(span.newest + 1) - 1, span.newest);
    const std::uint64_t begin = options.speed < 0 ? last : in.value_or(span.oldest);
    Transport transport = Transport::of_take(static_cast<double>(begin), options.speed);
    transport.mark(in, out);
    transport.set_loop(options.loops);
    return transport;
}

void play(const PlayOptions& options) {
    // It must exist before any other thread is started, so that it receives the signals.
    StopSignal stop;
    const auto take = std::make_shared<const TakeReader>(options.take);
    const TakeShow recorded = take_show_from(take->facts().show);
    if (is_time_zone(recorded.timecode_zone)) use_time_zone(recorded.timecode_zone);
    const auto sets = std::make_shared<const TakeFrameSets>(take);
    FlightStore flights = options.show.flight_store(options.take);
    FlightPlan plan = options.show.plan(recorded.view, flights);
    plan.habits = habits_of(*take);
    LiveSettings settings = options.show.settings(recorded.view, take->facts().pulse_rate_hz);
    settings.colours = recorded.colours;
    settings.take = sets;
    ClipStore clips = options.show.clip_store(options.take, take->facts().pulse_rate_hz);
    settings.replay = Replay(transport_of(options, *take, *sets->span()), clips.book());
    // Without operator input the session ends with the take,
    const bool has_operator_input = options.show.jog.value_or(!options.show.headless);
    // or with a move that is tied to the take's time.
    const bool leads = plan.move && plan.move->take_s_at(0);
    if (leads && options.show.headless && !has_operator_input && !plan.move->loops() &&
        !plan.frames && !plan.seconds)
        plan.seconds = plan.move->duration_s();
    settings.ends_with_take =
        options.show.headless && !has_operator_input && !plan.frames && !plan.seconds;
    if (settings.ends_with_take && (options.loops || options.speed == 0))
        fail("--loop and --speed 0 have no end; add --frames or --seconds with --headless");
    // It must exist before the threads that it records.
    const std::unique_ptr<TraceFile> trace = options.show.make_trace("vantage play");
    // The sound starts where the picture starts.
    const PulseGrid pulses(take->facts().pulse_rate_hz);
    const auto begin = static_cast<std::uint64_t>(*settings.replay.transport().pulse());
    settings.sound = options.show.sound(settings.rate_hz, {},
                                        take->facts().has_sound && options.show.audio.empty()
                                            ? open_take_sound(take, pulses.time_of(begin))
                                            : nullptr);
    const std::unique_ptr<JogDevices> deck = options.show.make_deck();
    LiveShow show(settings, plan, feed_of(*take), deck.get());
    ShowSession session{
        options.show,
        show,
        plan,
        deck.get(),
        flights,
        clips,
        options.show.desk_store(options.take),
        nullptr,
        options.take,
        [&](StopSignal& signal, const auto&) { return show.wait_for_first_frame_set(signal); }};
    session.run(stop);
}

}  // namespace

CommandEntry play_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<PlayOptions>();
        CLI::App* command = program.add_subcommand(
            "play", "Show a take like a live stage: scrub, freeze, fly, send the programme");
        namespace group = option_group;
        command->add_option("TAKE", options->take, "Take to play (.mkv)")->required();
        command
            ->add_option("--from", options->from,
                         "Set the in mark, in seconds after the beginning or as time code")
            ->group(group::input);
        command
            ->add_option("--to", options->to,
                         "Set the out mark, the first moment that is not played, likewise")
            ->group(group::input);
        command
            ->add_option("--speed", options->speed,
                         "Set the speed, -2 to 2; 1 is the original speed, 0 holds the picture")
            ->check(CLI::Range(-2.0, 2.0))
            ->capture_default_str()
            ->group(group::input);
        command->add_flag("--loop", options->loops, "Repeat from the in mark to the out mark")
            ->group(group::input);
        options->show.add_to(*command, "the stage's");
        command->footer(
            "Without --headless a window opens. Space holds and plays, [ and ] change the speed, "
            "F1 shows the keys.\nThe summary goes to stdout, the log to stderr.");
        command->callback([options] { play(*options); });
    }};
}

}  // namespace vantage
