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

struct LiveSettings {
    PictureFormat format;
    double rate_hz = 30;           ///< of the output
    double pulse_rate_hz = 30;     ///< of the stage
    std::size_t replay_bytes = 0;  ///< of frames kept to go back to; 0: none
    std::string synthesiser = default_synthesiser;
    QualityRequest quality;
    bool source_map = false;                ///< shown at first
    std::vector<std::string> outputs = {};  ///< URLs and files (see OutputUrl)
    std::string encoder = {};               ///< of the outputs; empty: chosen by trying
    bool overwrites = false;                ///< a film that is there may be replaced
    std::filesystem::path contact_sheet;    ///< empty: none
    bool free_flight = false;               ///< hands may leave the corridor
    bool compensate_gains = true;                  ///< the rigs' colours, by a ColourHarmoniser
    std::map<std::string, ColourCorrection> colours = {};  ///< by rig; others stay as they are
    SyncProof sync_proof = {};                             ///< of a live stage
    std::shared_ptr<const Background> set = nullptr;        ///< that rigs begin with; null: none
    std::shared_ptr<const PastFrameSets> take = nullptr;        ///< that is played; null: a live stage
    Replay replay = {};                                    ///< at first
    bool ends_with_take = false;                           ///< where it is played to its end
    std::shared_ptr<PictureSound> sound = nullptr;         ///< of the programme; null: none
};

/// The outputs that these settings ask for.
OutputSupervisor::Settings output_settings(const LiveSettings& settings);

/// Puts a live session together: frame sets, instants, programme, outputs and hands; and keeps the
/// books of all of them. All work is done on threads and OpenGL contexts of its own.
class LiveShow {
  public:
    /// Throws Error if the synthesiser is unknown, or cannot tell what the source map is to show,
    /// or there can be no stereoscopic picture of this width, or an output cannot be.
    /// Without a deck no wheel flies; else it must outlive the show.
    LiveShow(const LiveSettings& settings, const FlightPlan& plan, StageFeed feed, JogDevices* deck);

    /// Waits until an instant with all rigs is ready; at the limit, goes on with those that are
    /// there and says which are missing. Throws Error, with every rig's state, if none came, and at
    /// once if all rigs refuse this host. False: the program was asked to stop meanwhile.
    /// `while_waiting` is called all the time; what it throws ends the wait.
    bool wait_for_rigs(std::chrono::nanoseconds limit, StopSignal& stop,
                       const std::function<void()>& while_waiting = {});

    /// Of a take: until its first instant is ready. False: the program was asked to stop meanwhile.
    bool wait_for_first_frame_set(StopSignal& stop);

    /// Another output. Before start().
    void add(std::unique_ptr<PictureSink> sink) { programme_.add(std::move(sink)); }
    /// Starts the programme's clock.
    void start();
    /// Whether the plan is at its end. Throws what ended the programme.
    bool is_over() const { return programme_.is_over(); }
    /// Ends the programme, closes the books, ends the outputs.
    void finish();

    /// Precondition: finish().
    LiveReport report() const;

    const LiveSettings& settings() const { return settings_; }
    OutputSupervisor& outputs() { return outputs_; }
    const OutputSupervisor& outputs() const { return outputs_; }
    FlightControls& controls() { return controls_; }
    const FlightControls& controls() const { return controls_; }
    /// Null until the stage is known.
    std::shared_ptr<const Corridor> corridor() const { return stage_corridor_.now(); }
    /// Where the rigs stand; nothing until the stage is known.
    std::optional<StagePlaces> places() const { return stage_corridor_.places(); }
    ProgrammeState state() const { return programme_.state(); }
    ProgrammeStats stats() const { return programme_.stats(); }
    InstantThread::Stats instant_stats() const { return instants_.stats(); }
    ReceiverStatus status() const { return instants_.status(); }
    /// Of now; after finish(), as it was when that began.
    SignalState signal() const { return last_signal_.value_or(signal_of(status(), state())); }
    std::shared_ptr<const ReadyInstant> newest() const { return instants_.newest(); }
    /// As InstantThread's.
    void learn_background_anew() { instants_.learn_background_anew(); }
    std::future<Background> background() { return instants_.background(); }

  private:
    std::optional<OrbitView> rig_view(int number) const;
    /// Once an instant is ready.
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
    std::optional<MonotonicTime> framing_since_;  ///< of the programme's thread
    std::optional<ReceiverStatus> last_status_;
    std::optional<SignalState> last_signal_;
};

}  // namespace vantage
