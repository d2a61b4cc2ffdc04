#include "host_app/session/report/progress_log.h"

#include <numbers>

#include <fmt/format.h>

#include "common/base/log.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds telling_period{2};

}  // namespace

void ProgressLog::tell(const LiveShow& show) {
    if (MonotonicClock::now() - last_ >= telling_period) log_info("{}", line(show));
}

std::string ProgressLog::line(const LiveShow& show) {
    constexpr double deg = 180 / std::numbers::pi;
    const MonotonicTime now = MonotonicClock::now();
    const double elapsed_s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    int giving = 0;
    const ReceiverStatus status = show.status();
    for (const RigStatus& rig : status.rigs) giving += gives_pictures(rig, status.rigs);
    const ProgrammeStats stats = show.stats();
    const InstantThread::Stats instants = show.instant_stats();
    if (stats.pictures == 0) {
        instants_ = instants.prepared;
        if (status.sets == 0)
            return show.settings().take ? "no picture yet: no frame of the take was read yet"
                                        : "no picture yet: no rig has sent one";
        return fmt::format(
            "no picture yet: the renderer compiles its shaders, {} of {} rigs give pictures",
            giving, status.rigs.size());
    }
    const ProgrammeState state = show.state();
    // What is of no now has no signal, and was exposed long ago.
    const SignalState signal = show.signal();
    std::string now_words;
    if (!show.settings().take && signal != SignalState::live)
        now_words = fmt::format(", {}", title_of(signal));
    else if (!show.settings().take && state.latency_ms > 0)
        now_words = fmt::format(", {:.0f} ms from exposure to picture", state.latency_ms);
    std::string line = fmt::format(
        "{}{} pictures, {:.1f} a second, {} ticks reprojected, {} repeated, {:.1f} instants a "
        "second, {} of {} "
        "rigs{}, levels {}/{}, camera at azimuth {:.1f} degrees",
        stats.pictures, frames_ ? fmt::format(" of {}", *frames_) : "",
        static_cast<double>(stats.pictures - pictures_) / elapsed_s,
        stats.reprojected - reprojected_, stats.repeated - repeated_,
        static_cast<double>(instants.prepared - instants_) / elapsed_s, giving, status.rigs.size(),
        now_words, state.render_level(), state.prepare_level(), state.view.azimuth_rad * deg);
    pictures_ = stats.pictures;
    reprojected_ = stats.reprojected;
    repeated_ = stats.repeated;
    instants_ = instants.prepared;
    return line;
}

}  // namespace vantage
