#include "host_app/live/headless_flight.h"

#include "host_app/live/output_clock.h"
#include "host_app/live/progress_log.h"

namespace vantage {

std::uint64_t fly_headless(LiveSession& session, const FlightPlan& plan, JogDeck* deck,
                           double rate_hz, StopSignal& stop) {
    ProgressLog progress(plan);
    OutputClock clock(rate_hz, MonotonicClock::now());
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
        progress.tell(session, pictures + 1);
    }
    return clock.skipped();
}

}  // namespace vantage
