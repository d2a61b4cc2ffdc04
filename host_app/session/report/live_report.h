#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/percentiles.h"
#include "common/receive/rig_status.h"
#include "common/receive/signal_state.h"
#include "common/receive/stage_receiver.h"
#include "common/take/take_recorder.h"
#include "host_app/control/hid/jog_devices.h"
#include "host_app/control/ports/control_port.h"
#include "host_app/flight/corridor.h"
#include "host_app/flight/moves/move.h"
#include "host_app/flight/orbit_view.h"
#include "host_app/output/output_supervisor.h"
#include "host_app/programme/programme.h"
#include "host_app/refine/gain_compensation.h"
#include "host_app/sound/sound_source.h"
#include "host_app/synthesis/source_map.h"
#include "host_app/synthesis/stereoscopy.h"

namespace vantage {

/// The account of one rig's frames at the host.
struct RigAccount {
    RigStatus status;
    std::uint64_t fused = 0;     ///< frames of frame sets that became instants
    std::uint64_t replaced = 0;  ///< frames of frame sets that a newer one replaced
    /// The rig's gain compensation; nothing if it was never estimated.
    std::optional<GainCompensation::Rig> gain_compensation = {};
    std::optional<RigBackgroundState> background = {};  ///< nothing: no background is learnt
};

/// The reloads of the stage file that were done and refused, and the sentence of the last one.
struct StageReloads {
    std::uint64_t done = 0, refused = 0;
    std::string sentence;  ///< of the last one; empty: none was requested
    bool was_refused = false;
    MonotonicTime when{};  ///< of the last one
};

/// The state and the measurements of a session, for the summary, the metrics and the desk.
struct LiveReport {
    PictureFormat format;
    double rate_hz = 0;  ///< requested frame rate
    std::string synthesiser, renderer;
    // At the time of the report, or when the session ended:
    SignalState signal = SignalState::no_signal;
    TransportState time;
    ReplayState replay;
    std::uint64_t shown_pulse = 0;            ///< of the last picture
    std::optional<PastFrameSets::Span> past;  ///< the replay buffer or the take
    double pulse_rate_hz = 0;
    OrbitView view;  ///< of the last picture
    CorridorStats corridor;
    bool free_flight = false;              ///< the camera may leave the corridor
    std::vector<UncoveredPart> uncovered;  ///< parts of the planned move
    ProgrammeStats programme;
    int faults = 0;         ///< renderers and preparers that were created again after a fault
    int contexts_lost = 0;  ///< GPU resets that the session survived

    std::uint64_t frame_sets_closed = 0, frame_sets_complete = 0;
    std::uint64_t instants_prepared = 0;
    std::uint64_t frame_sets_replaced = 0;  ///< by a newer one before they were prepared
    std::uint64_t frame_sets_dropped = 0;   ///< before the session took any
    std::uint64_t instants_between = 0;     ///< interpolated between two pulses
    std::vector<RigAccount> rigs;           ///< in the stage's order

    RigSteps rig_steps;
    /// Steps of a frame at the host: network and decode of the slowest rig, encode of the slowest
    /// output. A step that was not done has no samples.
    Percentiles network_ms, decode_ms, prepare_ms, encode_ms;

    std::optional<Stereoscopy> stereoscopy;  ///< of the last picture
    std::optional<SourceShares> source_map;  ///< of the last picture, if the source map was shown

    StageReloads reloads;
    std::vector<DeckDevice> wheels;

    std::optional<TakeState> take;  ///< nothing: none was recorded
    std::string saved_background;   ///< the last file; empty: none was saved
    std::string played;             ///< the take that was played; empty: a live stage

    std::optional<SoundState> sound;  ///< nothing: the programme has no sound
    std::vector<OutputState> outputs;
    std::vector<PortState> ports;
};

/// A counter of a rig: its JSON key, its heading in the tables, and its key before it was renamed.
struct Counter {
    const char *key, *heading;
    std::uint64_t value;
    const char* old_key = nullptr;  ///< deprecated; null: it has always had this key
};
/// The counters of one place on a frame's way. Together they account for every frame there.
struct CounterGroup {
    const char *key, *title;
    std::vector<Counter> counters;
};
std::vector<CounterGroup> counters_of(const RigAccount& rig);

/// The durations of a step of a frame.
struct StepTime {
    std::string name;
    Percentiles ms;
};
/// Returns the steps that have samples: at the rigs those of the slowest one, then at the host.
std::vector<StepTime> step_times(const LiveReport& report);
/// Formats levels of quality and their shares of the time, such as "4: 96 %, 5: 4 %".
std::string shares_text(const std::vector<double>& shares);
/// Returns a sentence for every output that has failed and is not on again.
std::vector<std::string> failures_of(const LiveReport& report);
double new_frames_per_second(const ProgrammeStats& programme);

/// Formats the report as one JSON object; the keys have units.
nlohmann::ordered_json to_json(const LiveReport& report);
/// Formats the report as the text of the summary.
std::string to_text(const LiveReport& report);
/// Returns "connected", "disconnected" or "refused: ...".
std::string state_of(const RigStatus& status);
/// Returns the state with its reason, such as "disconnected: connection refused at ...".
std::string full_state_of(const RigStatus& status);
/// Describes the rig's outages and restarts since this host connected; empty if there were none.
std::string outages_of(const RigStatus& status);
/// Explains the headings of the counters, in several lines.
std::string counters_legend();

/// Returns the faults of a connected rig that a technician should look at, in a few words each:
/// heat, supply, clock, network.
std::vector<std::string> worries_of(const RigStatus& status);
/// Says why the rig's frames do not come over SRT. Precondition: it has a datagram_trouble.
std::string road_worry(const RigStatus& status);
/// Returns only those of the computer: heat and supply.
std::vector<std::string> computer_worries_of(const RigStatus& status);

// Short texts about a rig's state for the desk and for `vantage rigs status`.

/// Formats the state of a rig's clock: "PTP -120 ns", "this computer" or "no PTP"; empty if the rig
/// is disconnected.
std::string short_clock_words(const RigStatus& rig);

/// Returns the whole days since a date such as 2026-11-23 or 2026-11-23T07:30:00Z, and 0 for a date
/// in the future; nothing if it is not a date.
std::optional<int> days_since(const std::string& date, std::chrono::system_clock::time_point now);

/// Formats age and residual of a calibration, such as "12 d, 0.21 px"; empty if there is none.
std::string calibration_words(const RigHealth& health, std::chrono::system_clock::time_point now);

/// Whether a rig sends frames that the stage of these rigs can use.
bool delivers(const RigStatus& rig, const std::vector<RigStatus>& rigs);

/// Whether a rig is armed and starts with the first pulse of a host.
bool waits_for_a_host(const RigStatus& rig);

/// Explains why a connected rig without any other trouble sends nothing, and what to check; empty
/// for any other rig.
std::string silence_of(const RigStatus& rig);

}  // namespace vantage
