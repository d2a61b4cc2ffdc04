#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/percentiles.h"
#include "common/receive/stage_receiver.h"
#include "host_app/control/hid/jog_deck.h"
#include "host_app/flight/orbit_view.h"
#include "host_app/synthesis/colour_harmoniser.h"
#include "host_app/synthesis/novelty_overlay.h"
#include "host_app/synthesis/stereoscopy.h"

namespace vantage {

/// What became of one rig's frames at the host.
struct RigAccount {
    RigStatus status;
    std::uint64_t fused = 0;       ///< in sets that the virtual view was made from
    std::uint64_t superseded = 0;  ///< in sets that a newer one replaced before a picture was due
    /// What live harmonisation adds to its colours; nothing if it never did.
    std::optional<ColourHarmoniser::Rig> harmony = {};
};

struct StageTime {
    std::string stage;
    Percentiles ms;
};

/// All that a live session did, for the closing summary and the operator's panel.
struct LiveReport {
    int width_px = 0, height_px = 0;
    double rate_hz = 0;
    std::string synthesiser, renderer;
    double duration_s = 0;
    OrbitView view;  ///< of the last picture
    std::uint64_t pictures = 0;
    std::uint64_t skipped_ticks = 0;  ///< of the output, for which no picture was ready in time

    std::uint64_t sets_closed = 0, sets_complete = 0;
    std::uint64_t sets_fused = 0, sets_superseded = 0, sets_dropped = 0;
    std::vector<RigAccount> rigs;  ///< in the stage's order

    /// The way of a frame: capture, rectify, match, pack (at the rigs), network, decode, upload,
    /// render, readback, encode. Of network and decode the worst rig's; without samples: not done.
    std::vector<StageTime> stages;
    Percentiles latency_ms;  ///< from exposure to the picture, of every set that was shown

    std::optional<Stereoscopy> stereoscopy;  ///< of the last picture, where it is two
    std::optional<NoveltyShares> novelty;    ///< of the last picture, where it shows novelty

    std::vector<DeckDevice> wheels;  ///< jog controllers at the end of the flight

    std::string film;  ///< path; empty: none
    std::uint64_t film_pictures = 0, film_dropped = 0;
};

/// For machines: keys with units, one object.
nlohmann::ordered_json to_json(const LiveReport& report);
/// For people: several lines.
std::string to_text(const LiveReport& report);
/// "connected", "disconnected" or "refused: ...".
std::string state_of(const RigStatus& status);

/// What of a connected rig a technician should look after, a few words each: heat, supply, clock.
std::vector<std::string> worries_of(const RigStatus& status);

}  // namespace vantage
