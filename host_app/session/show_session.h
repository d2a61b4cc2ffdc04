#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/base/cli/stop_signal.h"
#include "host_app/metrics/metrics_server.h"
#include "host_app/session/background_saver.h"
#include "host_app/session/control_room.h"
#include "host_app/session/live_show.h"
#include "host_app/session/options/show_options.h"
#include "host_app/session/stage_reload.h"
#include "host_app/session/web_feed.h"
#include "host_app/takes/take_control.h"

namespace vantage {

/// A session of `vantage live` or `vantage play`: the loop that joins a show with window, control
/// ports, stores and reports, from the first picture to the summary. Everything runs on the thread
/// that calls run(). The referenced objects must outlive it.
struct ShowSession {
    const ShowOptions& options;
    LiveShow& show;
    const FlightPlan& plan;
    const JogDevices* deck;  ///< null: no jog wheels
    FlightStore& flights;
    ClipStore& clips;
    std::optional<DeskStore> desk;  ///< nothing: no window
    TakeControl* takes;             ///< null: no take can be recorded
    std::string played;             ///< path of the take that is shown; empty: a live stage
    /// Without a window: waits for the first instant, and calls `while_waiting` repeatedly. Returns
    /// false if the program is told to stop.
    std::function<bool(StopSignal&, const std::function<void()>& while_waiting)> wait;
    StageReload* stage = nullptr;     ///< null: the show has no stage file
    ReloadSignal* hang_up = nullptr;  ///< null: no signal reloads the stage
    std::uint64_t told_notices = 0;   ///< replay notices in the log so far
    std::optional<MetricsServer> metrics = {};
    MonotonicTime metrics_shown{};
    std::optional<WebFeed> web = {};
    AirWatch air = {};
    MonotonicTime followed{};  ///< the frame set in which a performer was tracked last

    /// Runs to the end and prints the summary. Throws Error if an output or the take has failed.
    void run(StopSignal& stop);

  private:
    void run_headless(StopSignal& stop, ControlRoom& room, BackgroundSaver& backgrounds);
    void run_in_window(StopSignal& stop, ControlRoom& room, BackgroundSaver& backgrounds);
    void keep_flights(const SessionRequests& requests);
    void cue_time(const std::string& words);
    void follow_replay(MonotonicTime now);
    LiveReport report_now() const;
    std::optional<TakeState> report_take() const;
    void show_metrics(const ControlRoom& room, MonotonicTime now);
    void find_pivots(const SessionRequests& requests, MonotonicTime now);
    void follow_requests(class OutputSwitch& outputs, BackgroundSaver& backgrounds,
                         ControlRoom& room, MonotonicTime now);
    void finish(ControlRoom& room, BackgroundSaver& backgrounds,
                const class CorridorWatch& corridor,
                const std::function<ColourImage()>& last_picture);
};

}  // namespace vantage
