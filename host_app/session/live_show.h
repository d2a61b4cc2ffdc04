#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/base/cli/stop_signal.h"
#include "common/colour/colour_correction.h"
#include "common/gl/context/context_group.h"
#include "host_app/control/flight_controls.h"
#include "host_app/frames/stage_feed.h"
#include "host_app/output/output_supervisor.h"
#include "host_app/programme/programme.h"
#include "host_app/session/report/live_report.h"
#include "host_app/session/stage_corridor.h"
#include "host_app/session/sync_proof.h"

namespace vantage {

/// The settings of a LiveShow.
struct LiveSettings {
    PictureFormat format;
    double rate_hz = 30;           ///< frames per second of the programme
    double pulse_rate_hz = 30;     ///< pulses per second of the stage
    std::size_t replay_bytes = 0;  ///< size of the replay buffer; 0: none
    std::string synthesiser = default_synthesiser;
    QualityRequest quality;
    bool source_map = false;                                 ///< shown from the start
    std::vector<std::string> outputs = {};                   ///< URLs and files (see OutputUrl)
    std::string encoder = {};                                ///< empty: the first that works
    bool overwrites = false;                                 ///< films may replace existing files
    std::filesystem::path contact_sheet;                     ///< empty: none
    bool free_flight = false;                                ///< the camera may leave the corridor
    bool compensate_gains = true;                            ///< equalise the rigs' colours
    std::map<std::string, ColourCorrection> colours = {};    ///< by rig; others are not corrected
    SyncProof sync_proof = {};                               ///< of a live stage
    std::shared_ptr<const Background> background = nullptr;  ///< to start with; null: none
    std::shared_ptr<const PastFrameSets> take = nullptr;     ///< to play; null: a live stage
    Replay replay = {};                                      ///< state at the start
    bool ends_with_take = false;                             ///< ends when the take has been played
    std::shared_ptr<PictureSound> sound = nullptr;           ///< null: none
};

/// Extracts the settings of the outputs.
OutputSupervisor::Settings output_settings(const LiveSettings& settings);

/// A show from frame sets to outputs: it owns the instants, the flight controls, the programme and
/// the outputs, and collects their stats. Its work runs on its own threads and OpenGL contexts; its
/// methods are called from the session's thread.
class LiveShow {
  public:
    /// Throws Error if the synthesiser is unknown or has no source map though one is requested, if
    /// the width does not suit the stereoscopic layout, or if an output cannot be opened. `deck` is
    /// null without jog wheels and must outlive the show otherwise.
    LiveShow(const LiveSettings& settings, const FlightPlan& plan, StageFeed feed,
             JogDevices* deck);

    /// The longest that wait_for_rigs() waits beyond its limit for rigs that report that they
    /// start, such as while their GPU compiles shaders.
    static constexpr std::chrono::minutes longest_start{5};

    /// Waits for an instant with all rigs. After `limit`, counted from when no missing rig reports
    /// any more that it starts, it continues with the rigs that are present and logs the missing
    /// ones. Throws Error, with every rig's state, if no rig sent a
    /// frame, and immediately if all rigs refuse this host. Returns false if the program is told to
    /// stop. `while_waiting` is called repeatedly; an exception from it ends the wait.
    bool wait_for_rigs(std::chrono::nanoseconds limit, StopSignal& stop,
                       const std::function<void()>& while_waiting = {},
                       std::chrono::nanoseconds start_limit = longest_start);

    /// Waits for the first instant of a take. Returns false if the program is told to stop.
    bool wait_for_first_frame_set(StopSignal& stop);

    /// Adds an output. Call it before start().
    void add(std::unique_ptr<PictureSink> sink) { programme_.add(std::move(sink)); }
    /// Starts the programme's clock.
    void start();
    /// Returns whether the plan has ended. Rethrows the error that ended the programme.
    bool is_over() const { return programme_.is_over(); }
    /// Stops the programme, ends the outputs and freezes the stats.
    void finish();

    /// Returns the state and the stats so far, or the final ones after finish().
    LiveReport report() const;

    const LiveSettings& settings() const { return settings_; }
    /// The reloads of the stage file so far. Used on the session's thread.
    void note_reload(const StageReloads& reloads) { reloads_ = reloads; }
    const StageReloads& reloads() const { return reloads_; }
    OutputSupervisor& outputs() { return outputs_; }
    const OutputSupervisor& outputs() const { return outputs_; }
    FlightControls& controls() { return controls_; }
    const FlightControls& controls() const { return controls_; }
    /// The corridor; null until the stage is known.
    std::shared_ptr<const Corridor> corridor() const { return stage_corridor_.now(); }
    /// The positions of the rigs; nothing until the stage is known.
    std::optional<StagePlaces> places() const { return stage_corridor_.places(); }
    ProgrammeState state() const { return programme_.state(); }
    ProgrammeStats stats() const { return programme_.stats(); }
    InstantThread::Stats instant_stats() const { return instants_.stats(); }
    ReceiverStatus status() const { return instants_.status(); }
    /// The present signal, or the one when finish() was called.
    SignalState signal() const { return last_signal_.value_or(signal_of(status(), state())); }
    std::shared_ptr<const ReadyInstant> newest() const { return instants_.newest(); }
    // See InstantThread.
    void learn_background_anew() { instants_.learn_background_anew(); }
    void set_colours(std::map<std::string, ColourCorrection> colours) {
        instants_.set_colours(std::move(colours));
    }
    std::future<Background> background() { return instants_.background(); }

  private:
    std::optional<OrbitView> rig_view(int number) const;
    /// Frames the stage once enough rigs are present.
    std::optional<StageFraming> framing();
    std::shared_ptr<const Corridor> corridor_now();
    SignalState signal_of(const ReceiverStatus& status, const ProgrammeState& state) const;

    LiveSettings settings_;
    FlightPlan plan_;
    ContextGroup contexts_;
    std::string renderer_;
    InstantThread instants_;
    StageCorridor stage_corridor_;
    FlightControls controls_;
    OutputSupervisor outputs_;
    Programme programme_;
    std::optional<MonotonicTime> framing_since_;  ///< used on the programme's thread
    StageReloads reloads_;
    std::optional<ReceiverStatus> last_status_;
    std::optional<SignalState> last_signal_;
};

}  // namespace vantage
