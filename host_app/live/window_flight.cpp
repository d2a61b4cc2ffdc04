#include "host_app/live/window_flight.h"

#include "host_app/live/output_clock.h"
#include "host_app/live/panel_feed.h"
#include "host_app/live/progress_log.h"

namespace vantage {

std::uint64_t fly_in_window(LiveSession& session, OperatorWindow& window, const FlightPlan& plan,
                            JogDeck* deck, double rate_hz, StopSignal& stop) {
    FlightControls controls(plan, session, deck);
    PanelFeed panel;
    ProgressLog progress(plan);
    OutputClock clock(rate_hz, MonotonicClock::now());
    double last_s = 0;
    for (std::uint64_t pictures = 0;; ++pictures) {
        if (stop.wait_for(clock.until_next(MonotonicClock::now()))) break;
        const std::chrono::nanoseconds time = clock.time_of(clock.next_tick(MonotonicClock::now()));
        const double time_s = std::chrono::duration<double>(time).count();
        if (plan.is_over(pictures, time_s)) break;
        const FlightInput hands = window.poll(time_s - last_s);
        last_s = time_s;
        if (window.closed()) break;
        const OrbitView view = controls.step(hands, session, time_s);
        const Texture& picture = session.make_picture(view, time);
        window.show(panel.state(session, picture, view, controls, pictures));
        progress.tell(session, pictures + 1);
    }
    return clock.skipped();
}

}  // namespace vantage
