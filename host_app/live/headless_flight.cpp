#include "host_app/live/headless_flight.h"

#include <numbers>

#include "common/base/log.h"
#include "host_app/live/output_clock.h"

namespace vantage {
namespace {

constexpr std::chrono::seconds progress_period{2};

void log_progress(LiveSession& session, const FlightPlan& plan, std::uint64_t pictures,
                  double seconds) {
    int connected = 0;
    const ReceiverStatus& status = session.refresh_status();
    for (const RigStatus& rig : status.rigs) connected += rig.connected;
    constexpr double deg = 180 / std::numbers::pi;
    log_info(
        "{}{} pictures, {:.1f} a second, {} of {} rigs, {:.0f} ms from exposure to picture, "
        "camera at azimuth {:.1f} degrees",
        pictures, plan.frames ? fmt::format(" of {}", *plan.frames) : "",
        seconds > 0 ? static_cast<double>(pictures) / seconds : 0.0, connected, status.rigs.size(),
        session.latest_latency_ms(), session.last_view().azimuth_rad * deg);
}

}  // namespace

std::uint64_t fly_headless(LiveSession& session, const FlightPlan& plan, JogDeck* deck,
                           double rate_hz, StopSignal& stop) {
    const MonotonicTime start = MonotonicClock::now();
    MonotonicTime next_progress = start + progress_period;
    OutputClock clock(rate_hz, start);
    FlightControls controls(plan, session, deck);
    const bool ends_with_move =
        plan.move && !plan.move->loops() && !plan.frames && !plan.seconds && !deck;
    for (std::uint64_t pictures = 0;; ++pictures) {
        if (stop.wait_for(clock.until_next(MonotonicClock::now()))) break;
        const std::chrono::nanoseconds time = clock.time_of(clock.next_tick(MonotonicClock::now()));
        const double time_s = std::chrono::duration<double>(time).count();
        if (plan.is_over(pictures, time_s)) break;
        if (ends_with_move && time_s > plan.move->duration_s()) break;
        session.make_picture(controls.step({}, session, time_s), time);
        if (MonotonicClock::now() >= next_progress) {
            next_progress += progress_period;
            log_progress(session, plan, pictures + 1,
                         std::chrono::duration<double>(MonotonicClock::now() - start).count());
        }
    }
    return clock.skipped();
}

}  // namespace vantage
