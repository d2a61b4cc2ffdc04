#include "host_app/live/progress_log.h"

#include <numbers>

#include "common/base/log.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds telling_period{2};

}  // namespace

void ProgressLog::tell(const LiveShow& show) {
    constexpr double deg = 180 / std::numbers::pi;
    const MonotonicTime now = MonotonicClock::now();
    if (now - last_ < telling_period) return;
    const double elapsed_s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    int giving = 0;
    const ReceiverStatus status = show.status();
    for (const RigStatus& rig : status.rigs) giving += gives_pictures(rig, status.rigs);
    const ProgrammeBooks books = show.books();
    const InstantThread::Books instants = show.instant_books();
    const ProgrammeState state = show.state();
    log_info(
        "{}{} pictures, {:.1f} a second, {} ticks repeated, {:.1f} instants a second, {} of {} "
        "rigs, {:.0f} ms from exposure to picture, levels {}/{}, camera at azimuth {:.1f} degrees",
        books.pictures, frames_ ? fmt::format(" of {}", *frames_) : "",
        static_cast<double>(books.pictures - pictures_) / elapsed_s, books.repeated - repeated_,
        static_cast<double>(instants.prepared - instants_) / elapsed_s, giving, status.rigs.size(),
        state.latency_ms, state.render_level, state.prepare_level, state.view.azimuth_rad * deg);
    pictures_ = books.pictures;
    repeated_ = books.repeated;
    instants_ = instants.prepared;
}

}  // namespace vantage
