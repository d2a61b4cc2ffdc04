#include <cmath>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/base/cli/command.h"
#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/time_zone.h"
#include "host_app/session/options/take_time.h"
#include "host_app/session/show_session.h"
#include "host_app/sound/take_sound.h"
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
    // Before any other thread, so that they leave the signals to it.
    StopSignal stop;
    const auto take = std::make_shared<const TakeReader>(options.take);
    const TakeShow told = take_show_from(take->facts().show);
    if (is_time_zone(told.timecode_zone)) use_time_zone(told.timecode_zone);
    const auto sets = std::make_shared<const TakeFrameSets>(take);
    FlightStore flights = options.show.flight_store(options.take);
    FlightPlan plan = options.show.plan(told.view, flights);
    plan.habits = habits_of(*take);
    LiveSettings settings = options.show.settings(told.view, take->facts().pulse_rate_hz);
    settings.colours = told.colours;
    settings.take = sets;
    ClipStore clips = options.show.clip_store(options.take, take->facts().pulse_rate_hz);
    settings.replay = Replay(transport_of(options, *take, *sets->span()), clips.book());
    // What nobody steers ends with the take.
    const bool has_operator_input = options.show.jog.value_or(!options.show.headless);
    // A flight that says where in the take it is ends by itself.
    const bool leads = plan.move && plan.move->take_s_at(0);
    if (leads && options.show.headless && !has_operator_input && !plan.move->loops() && !plan.frames &&
        !plan.seconds)
        plan.seconds = plan.move->duration_s();
    settings.ends_with_take = options.show.headless && !has_operator_input && !plan.frames && !plan.seconds;
    if (settings.ends_with_take && (options.loops || options.speed == 0))
        fail("what loops or stands has no end: say --frames or --seconds with --headless");
    // It begins with what is heard where the take is begun.
    const PulseGrid pulses(take->facts().pulse_rate_hz);
    const auto begin = static_cast<std::uint64_t>(*settings.replay.transport().pulse());
    settings.sound = options.show.sound(settings.rate_hz, {},
                                        take->facts().has_sound && options.show.audio.empty()
                                            ? open_take_sound(take, pulses.time_of(begin))
                                            : nullptr);
    const std::unique_ptr<JogDevices> deck = options.show.make_deck();
    LiveShow show(settings, plan, feed_of(*take), deck.get());
    ShowSession session{options.show,
                        show,
                        plan,
                        deck.get(),
                        flights,
                        clips,
                        options.show.desk_store(options.take),
                        nullptr,
                        options.take,
                        [&](StopSignal& signal) { return show.wait_for_first_frame_set(signal); }};
    session.run(stop);
}

}  // namespace

CommandEntry play_command_entry() {
    return {[](CLI::App& program) {
        auto options = std::make_shared<PlayOptions>();
        CLI::App* command = program.add_subcommand(
            "play", "All of vantage live on a take: scrub, freeze, fly, put out");
        command->add_option("TAKE", options->take, "The take (.mkv)")->required();
        command->add_option("--from", options->from,
                            "In mark: seconds after the beginning, or time code");
        command->add_option("--to", options->to,
                            "Out mark, the first that is not played, likewise");
        command->add_option("--speed", options->speed, "-2 to 2; 1 is as it was, 0 stands")
            ->check(CLI::Range(-2.0, 2.0))
            ->capture_default_str();
        command->add_flag("--loop", options->loops, "From the out mark on at the in mark");
        options->show.add_to(*command, "the stage's");
        command->footer(
            "Without --headless a window opens: space stops and plays on, [ and ] change the "
            "speed, F1 helps.\nThe summary goes to stdout, the log to stderr.");
        command->callback([options] { play(*options); });
    }};
}

}  // namespace vantage
