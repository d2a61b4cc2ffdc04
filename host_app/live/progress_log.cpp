#include "host_app/live/progress_log.h"

#include <numbers>

#include "common/base/log.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds period{2};

}  // namespace

void ProgressLog::tell(LiveSession& session, std::uint64_t pictures) {
    constexpr double deg = 180 / std::numbers::pi;
    const MonotonicTime now = MonotonicClock::now();
    if (now - last_ < period) return;
    last_ = now;
    int connected = 0;
    const ReceiverStatus& status = session.refresh_status();
    for (const RigStatus& rig : status.rigs) connected += rig.connected;
    log_info(
        "{}{} pictures, {:.1f} a second, {} of {} rigs, {:.0f} ms from exposure to picture, "
        "camera at azimuth {:.1f} degrees",
        pictures, frames_ ? fmt::format(" of {}", *frames_) : "",
        static_cast<double>(pictures) / std::chrono::duration<double>(now - start_).count(),
        connected, status.rigs.size(), session.latest_latency_ms(),
        session.last_view().azimuth_rad * deg);
}

}  // namespace vantage
