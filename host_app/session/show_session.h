#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/base/cli/stop_signal.h"
#include "common/config/stage_config.h"
#include "host_app/desk/desk_store.h"
#include "host_app/flight/moves/flight_store.h"
#include "host_app/metrics/metrics_server.h"
#include "host_app/replay/clip_store.h"
#include "host_app/session/background_saver.h"
#include "host_app/session/control_room.h"
#include "host_app/session/live_show.h"
#include "host_app/session/options/stereoscopic_options.h"
#include "host_app/takes/take_control.h"

namespace vantage {

/// The options that every show has, be it live or of a take.
struct ShowOptions {
    std::string path, flight, clips, desk, snapshot, film, contact_sheet, size, synthesiser, wheels,
        encoder, rate;
    std::string set, saved_background;
    std::string metrics;  ///< where they are told; empty: nowhere
    std::string audio;    ///< where sound comes from; empty: nowhere
    std::optional<double> audio_delay_ms;
    std::vector<std::string> outputs, controls;
    std::string quality = "auto";
    std::uint64_t frames = 0;
    double seconds = 0;
    bool headless = false, json = false, source_map = false, compensate_gains = true,
         overwrite = false;
    bool free_flight = false;
    StereoscopicOptions stereoscopic;
    std::optional<bool> jog;  ///< default: with a window

    void add_to(CLI::App& command, const std::string& default_rate);

    /// Throw Error for what cannot be.
    LiveSettings settings(const StageConfig::View& view, double pulse_rate_hz) const;
    /// `flights`: what is kept of shots and moves.
    FlightPlan plan(const StageConfig::View& view, FlightStore& flights) const;
    /// `beside`: the stage or the take. Throws Error as load_flight().
    FlightStore flight_store(const std::string& beside) const;
    /// Likewise, as load_clips().
    ClipStore clip_store(const std::string& beside, double pulse_rate_hz) const;
    /// Likewise, as load_desk(). Nothing: there is no window.
    std::optional<DeskStore> desk_store(const std::string& beside) const;
    std::unique_ptr<JogDevices> make_deck() const;
    /// What `--audio` asks for, else what `source` is; null: no sound. `tap`: for a take. Throws
    /// Error as open_sound().
    std::shared_ptr<PictureSound> sound(double rate_hz, const SoundTap& tap,
                                        std::shared_ptr<SoundSource> source = nullptr) const;
};

/// A show from its first picture to its summary.
struct ShowSession {
    const ShowOptions& options;
    LiveShow& show;
    const FlightPlan& plan;
    const JogDevices* deck;
    FlightStore& flights;
    ClipStore& clips;
    std::optional<DeskStore> desk;
    TakeControl* takes;  ///< null: nothing can be recorded
    std::string played;  ///< the take that is shown; empty: the stage is live
    /// Without a window: waits until there is something to show. False: it was told to stop.
    std::function<bool(StopSignal&)> wait;
    std::uint64_t told_notices = 0;  ///< of replay, in the log
    std::optional<MetricsServer> metrics = {};
    MonotonicTime metrics_shown{};
    MonotonicTime followed{};  ///< the set in which a performer was looked for last

    void run(StopSignal& stop);

  private:
    void run_headless(StopSignal& stop, ControlRoom& room, BackgroundSaver& sets);
    void run_in_window(StopSignal& stop, ControlRoom& room, BackgroundSaver& sets);
    void keep_flights(const SessionRequests& requests);
    void cue_time(const std::string& words);
    void follow_replay(MonotonicTime now);
    LiveReport report_now() const;
    void show_metrics(const ControlRoom& room, MonotonicTime now);
    void find_pivots(const SessionRequests& requests, MonotonicTime now);
    void follow_requests(class OutputSwitch& outputs, BackgroundSaver& sets, ControlRoom& room,
                         MonotonicTime now);
    void finish(ControlRoom& room, BackgroundSaver& sets, const class CorridorWatch& corridor,
                const std::function<ColourImage()>& last_picture);
};

}  // namespace vantage
