// How long a jump in a take lasts: plays for a while, so that the governor finds what fits, then
// jumps to random places and waits for the picture of each.
#include <iostream>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/base/percentiles.h"
#include "common/base/time/time.h"
#include "host_app/session/live_show.h"
#include "host_app/takes/take_frame_sets.h"
#include "host_app/takes/take_show.h"
#include "tests/bench/support/run_bench.h"
#include "tests/bench/support/size_option.h"

namespace vantage {
namespace {

struct Wanted {
    std::string take, size = "480x270";
    double rate_hz = 25, play_s = 8, pause_s = 0.3;
    int seeks = 200;
    std::uint64_t seed = 1;
};

/// False: no picture of that pulse came within five seconds.
bool shows(const LiveShow& show, std::uint64_t pulse) {
    constexpr int most_looks = 5000;
    for (int i = 0; i < most_looks; ++i) {
        const auto picture = show.state().picture;
        if (picture && picture->job.instant->set->trigger_index == pulse) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

void measure(const Wanted& wanted) {
    StopSignal stop;
    const auto take = std::make_shared<const TakeReader>(wanted.take);
    const TakeShow told = take_show_from(take->facts().show);
    const auto sets = std::make_shared<const TakeFrameSets>(take);
    const PastFrameSets::Span span = *sets->span();
    LiveSettings settings;
    const cv::Size size = size_of(wanted.size);
    settings.format = {.width_px = size.width, .height_px = size.height};
    settings.rate_hz = wanted.rate_hz;
    settings.pulse_rate_hz = take->facts().pulse_rate_hz;
    settings.colours = told.colours;
    settings.take = sets;
    Transport transport = Transport::of_take(static_cast<double>(span.oldest), 1);
    transport.set_loop(true);
    ClipBook no_clips;
    no_clips.pulse_rate_hz = settings.pulse_rate_hz;
    settings.replay = Replay(std::move(transport), std::move(no_clips));
    LiveShow show(settings, {}, feed_of(*take), nullptr);
    if (!show.wait_for_first_frame_set(stop)) fail("interrupted");
    show.start();
    std::this_thread::sleep_for(std::chrono::duration<double>(wanted.play_s));
    const ProgrammeState played = show.state();
    cv::RNG random(wanted.seed);
    int wrong = 0;
    PercentileRecorder asked_ms;
    for (int i = 0; i < wanted.seeks && !stop.requested(); ++i) {
        const double pulse = static_cast<double>(span.oldest) +
                             random.uniform(0.0, static_cast<double>(span.newest - span.oldest));
        const MonotonicTime asked = MonotonicClock::now();
        show.controls().seek(pulse);
        if (shows(show, *sets->pulse_at(pulse)))
            asked_ms.add(ms_since(asked));
        else
            ++wrong;
        // Between ticks, wherever.
        std::this_thread::sleep_for(
            std::chrono::duration<double>(wanted.pause_s * random.uniform(0.5, 1.5)));
    }
    show.finish();
    const ProgrammeStats stats = show.stats();
    std::cout << fmt::format(
        "{:.0f} s of {} rigs, {} jumps, {} of them without the right picture; levels when playing: "
        "render {}, prepare {}.\n\n"
        "| ms | median | 95 % | 99 % | most |\n| --- | --- | --- | --- | --- |\n",
        take->duration_s(), take->facts().rigs.size(), stats.seek_ms.count, wrong,
        played.render_level(), played.prepare_level());
    const auto row = [](const char* name, const Percentiles& p) {
        std::cout << fmt::format("| {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} |\n", name, p.p50, p.p95,
                                 p.p99, p.max);
    };
    row("command to picture", asked_ms.summary());
    row("jump to picture", stats.seek_ms);
    row("waiting", stats.seek_steps_ms.wait);
    row("fetching", stats.seek_steps_ms.fetch);
    row("preparing", stats.seek_steps_ms.prepare);
    row("rendering, tick", stats.seek_steps_ms.picture);
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    using namespace vantage;
    CLI::App app("How long jumps to random places of a take last");
    Wanted wanted;
    app.add_option("TAKE", wanted.take, "The take (.mkv)")->required();
    app.add_option("--size", wanted.size, "Of the picture")->capture_default_str();
    app.add_option("--rate", wanted.rate_hz, "Pictures a second")->capture_default_str();
    app.add_option("--play", wanted.play_s, "Seconds before the first jump")->capture_default_str();
    app.add_option("--pause", wanted.pause_s,
                   "Seconds between picture and next jump, half as long to one and a half")
        ->capture_default_str();
    app.add_option("--seeks", wanted.seeks, "Jumps")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    app.add_option("--seed", wanted.seed, "Of the places")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return run_bench("take_seeks", [&] { measure(wanted); });
}
