#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/percentiles.h"
#include "common/receive/signal_state.h"
#include "common/receive/stage_receiver.h"
#include "common/take/take_recorder.h"
#include "host_app/control/hid/jog_devices.h"
#include "host_app/control/ports/control_ports.h"
#include "host_app/flight/corridor.h"
#include "host_app/flight/moves/move_coverage.h"
#include "host_app/flight/orbit_view.h"
#include "host_app/output/output_supervisor.h"
#include "host_app/programme/programme.h"
#include "host_app/refine/gain_compensation.h"
#include "host_app/sound/sound_source.h"
#include "host_app/synthesis/source_map.h"
#include "host_app/synthesis/stereoscopy.h"

namespace vantage {

/// What became of one rig's frames at the host.
struct RigAccount {
    RigStatus status;
    std::uint64_t fused = 0;       ///< in sets that instants were made of
    std::uint64_t superseded = 0;  ///< in sets that a newer one replaced before they were prepared
    /// What live harmonisation adds to its colours; nothing if it never did.
    std::optional<GainCompensation::Rig> gain_compensation = {};
    std::optional<RigBackgroundState> set =
        {};  ///< what it has learnt of its set; nothing: none is learnt
};

/// All that a live session did, for the closing summary and the operator's desk.
struct LiveReport {
    PictureFormat format;
    double rate_hz = 0;  ///< that was asked for
    std::string synthesiser, renderer;
    SignalState signal = SignalState::no_signal;  ///< at the end
    TransportState time;                          ///< at the end
    ReplayState replay;                           ///< at the end
    std::uint64_t shown_pulse = 0;                ///< of the last picture
    std::optional<PastFrameSets::Span> past;           ///< that can be gone back to
    double pulse_rate_hz = 0;
    OrbitView view;  ///< of the last picture
    CorridorStats corridor;
    bool free_flight = false;              ///< hands may leave the corridor
    std::vector<UncoveredPart> uncovered;  ///< of the planned move
    ProgrammeStats programme;
    int faults = 0;         ///< renderers and preparers that were made anew
    int contexts_lost = 0;  ///< resets of the GPU that were got over

    std::uint64_t frame_sets_closed = 0, frame_sets_complete = 0;
    std::uint64_t instants_prepared = 0, frame_sets_superseded = 0, frame_sets_dropped = 0;
    std::uint64_t instants_between = 0;  ///< of moments between pulses
    std::vector<RigAccount> rigs;        ///< in the stage's order

    RigSteps rig_steps;
    /// Steps of a frame's way at the host; of network and decode the worst rig's, of encode the
    /// slowest output's. Without samples: not done.
    Percentiles network_ms, decode_ms, prepare_ms, encode_ms;

    std::optional<Stereoscopy> stereoscopy;  ///< of the last picture, where it is two
    std::optional<SourceShares> source_map;  ///< of the last picture, where its source map was shown

    std::vector<DeckDevice> wheels;  ///< jog controllers at the end of the flight

    std::optional<TakeState> take;  ///< that was recorded; nothing: there was none
    std::string saved_background;          ///< where the set was saved last; empty: nowhere
    std::string played;             ///< the take that was played; empty: the stage was live

    std::optional<SoundState> sound;  ///< nothing: the programme has none
    std::vector<OutputState> outputs;
    std::vector<PortState> ports;  ///< that others steered by
};

/// One counter of a rig: its key for machines and its heading for people.
struct Counter {
    const char *key, *heading;
    std::uint64_t value;
};
/// Counters of one place on the way, which together say what became of every frame there.
struct CounterGroup {
    const char *key, *title;
    std::vector<Counter> counters;
};
std::vector<CounterGroup> counters_of(const RigAccount& rig);

/// The steps of a frame's way, by name, of which there are samples: at the rigs as the worst of
/// them says, then at the host.
struct StepTime {
    std::string name;
    Percentiles ms;
};
std::vector<StepTime> step_times(const LiveReport& report);
/// Such as "4: 96 %, 5: 4 %": levels of quality and their shares of the time.
std::string shares_text(const std::vector<double>& shares);
/// A sentence for every output that has failed and is not on again, with its name.
std::vector<std::string> failures_of(const LiveReport& report);
/// New pictures a second.
double pictures_a_second(const ProgrammeStats& programme);

/// For machines: keys with units, one object.
nlohmann::ordered_json to_json(const LiveReport& report);
/// For people: several lines.
std::string to_text(const LiveReport& report);
/// "connected", "disconnected" or "refused: ...".
std::string state_of(const RigStatus& status);
/// The state, and why the rig gives nothing: "disconnected: connection refused at ...".
std::string full_state_of(const RigStatus& status);
/// When and how a rig was away since this host came; empty if it never was.
std::string outages_of(const RigStatus& status);
/// What the words over the counters mean, for people: several lines.
std::string counters_legend();

/// What of a connected rig a technician should look after, a few words each: heat, supply, clock.
std::vector<std::string> worries_of(const RigStatus& status);
/// Of those heat and supply alone.
std::vector<std::string> computer_worries_of(const RigStatus& status);

}  // namespace vantage
