#include "host_app/session/report/show_log.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/base/memory_pressure.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds progress_period{2};

}  // namespace

void ProgressLog::tell(const LiveShow& show) {
    if (MonotonicClock::now() - last_ >= progress_period) log_info("{}", line(show));
}

std::string ProgressLog::line(const LiveShow& show) {
    constexpr double deg = 180 / std::numbers::pi;
    const MonotonicTime now = MonotonicClock::now();
    const double elapsed_s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    int giving = 0;
    const auto is_of_stage = [](const RigStatus& rig) { return !rig.is_removed; };
    const ReceiverStatus status = show.status();
    for (const RigStatus& rig : status.rigs) giving += gives_pictures(rig, status.rigs);
    const auto of_stage = std::count_if(status.rigs.begin(), status.rigs.end(), is_of_stage);
    const ProgrammeStats stats = show.stats();
    const InstantThread::Stats instants = show.instant_stats();
    if (stats.pictures == 0) {
        instants_ = instants.prepared;
        if (status.sets == 0)
            return show.settings().take ? "no picture yet: no frame of the take was read yet"
                                        : "no picture yet: no rig has sent a frame";
        return fmt::format(
            "no picture yet: the renderer compiles its shaders, {} of {} rigs send frames", giving,
            of_stage);
    }
    const ProgrammeState state = show.state();
    // A take has neither signal nor latency.
    const SignalState signal = show.signal();
    std::string now_words;
    if (!show.settings().take && signal != SignalState::live)
        now_words = fmt::format(", {}", title_of(signal));
    else if (!show.settings().take && state.latency_ms > 0)
        now_words = fmt::format(", {:.0f} ms from exposure to picture", state.latency_ms);
    std::string line = fmt::format(
        "{}{} frames, {:.1f} fps, {} ticks reprojected, {} repeated, {:.1f} instants per second, "
        "{} of {} rigs{}, levels {}/{}, camera at azimuth {:.1f} degrees",
        stats.pictures, frames_ ? fmt::format(" of {}", *frames_) : "",
        static_cast<double>(stats.pictures - pictures_) / elapsed_s,
        stats.reprojected - reprojected_, stats.repeated - repeated_,
        static_cast<double>(instants.prepared - instants_) / elapsed_s, giving, of_stage, now_words,
        state.render_level(), state.prepare_level(), state.view.azimuth_rad * deg);
    pictures_ = stats.pictures;
    reprojected_ = stats.reprojected;
    repeated_ = stats.repeated;
    instants_ = instants.prepared;
    return line;
}

void ComputerWatch::tell() {
    const MonotonicTime now = MonotonicClock::now();
    if (now - last_ < progress_period) return;
    last_ = now;
    const std::string worry = memory_worry(memory_pressure());
    if (is_short_ == !worry.empty()) return;
    is_short_ = !worry.empty();
    if (is_short_)
        log_warning("{}", worry);
    else
        log_info("this computer has memory again");
}

void CorridorWatch::tell(const LiveShow& show) {
    check_move(show);
    const std::optional<Coverage> now = show.controls().lines().corridor.now;
    if (!now) return;
    const double percent = 100 * now->share;
    const char* lost = words_of(now->loss);
    switch (Corridor::place_of(now->share)) {
        case CorridorPlace::inside:
            break;
        case CorridorPlace::edge:
            if (!std::exchange(told_edge_, true))
                log_warning(
                    "the camera is at the edge of the area the rigs cover: {:.0f} % of its "
                    "picture; most of the rest {}",
                    percent, lost);
            break;
        case CorridorPlace::beyond:
            if (!std::exchange(told_beyond_, true))
                log_warning(
                    "the camera is outside the area the rigs cover: {:.0f} % of its picture; most "
                    "of the rest {}",
                    percent, lost);
            break;
    }
}

void CorridorWatch::check_move(const LiveShow& show) {
    if (!move_) return;
    const std::shared_ptr<const Corridor> corridor = show.corridor();
    if (!corridor) return;
    parts_ = vantage::uncovered_parts(*move_, *corridor);
    move_.reset();
    for (const UncoveredPart& part : parts_)
        log_warning(
            "the planned move leaves the area the rigs cover from {:.1f} to {:.1f} s: at worst "
            "{:.0f} % of its picture is covered; most of the rest {}",
            part.from_s, part.to_s, 100 * part.least.share, words_of(part.least.loss));
}

}  // namespace vantage
