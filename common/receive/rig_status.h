#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/percentiles.h"
#include "common/base/time/time.h"
#include "common/wire/link_message.h"

namespace vantage {

/// The host's knowledge of one rig's stream since its first message from the rig, over all outages
/// and restarts. The counts balance at any moment, except for frames that a dying rig loses after
/// its last message:
///   rig_counters.captured = published + late + inside the rig
///   link.offered = link.sent + link.send_dropped + link.skipped + queued at the rig
///   link.sent = arrived + lost + under way
///   arrived = received + undecodable (frames) + queue_dropped + being decoded
///   received = in_frame_sets + late + duplicate + unsynchronized + out_of_step
///              + in open frame sets
struct RigStatus {
    std::string rig;
    std::string endpoint;
    bool connected = false;      ///< a frame or heartbeat came within the last second
    bool is_removed = false;     ///< the stage file names it no longer
    std::string refused;         ///< why the rig refused this host, in a sentence; empty: not
    std::string unreachable;     ///< why nothing answers, if known
    std::uint64_t outages = 0;   ///< number of times that the connected rig disconnected
    double outage_s = 0;         ///< total time of the outages so far
    std::uint64_t restarts = 0;  ///< restarts of its daemon
    double stage_rate_hz = 0;    ///< rate that the stage configures; the rig's own is in sync
    std::uint64_t received = 0;  ///< frames decoded
    std::uint64_t undecodable =
        0;  ///< messages that the decoder refused; the last reason is in last_error
    std::uint64_t lost = 0;           ///< sent by the rig, not received: the connection broke
    std::uint64_t in_frame_sets = 0;  ///< frames in closed frame sets
    std::uint64_t in_dropped_frame_sets = 0;  ///< of those: in frame sets dropped by next()
    std::uint64_t late = 0;                   ///< frames that came after their frame set was closed
    std::uint64_t duplicate = 0;              ///< further frames of the same pulse
    std::uint64_t unsynchronized = 0;         ///< frames without a pulse of the stage
    /// Frames that came while the rig counted pulses differently from the rest.
    std::uint64_t out_of_step = 0;
    bool is_out_of_step = false;      ///< whether it does so now
    bool names_no_pulse = false;      ///< whether its recent frames have no pulse of the stage
    bool lags = false;                ///< its frames are so late that the host does not wait
    std::uint64_t queue_dropped = 0;  ///< frames dropped because the host's decoder was busy

    LinkCounters link;         ///< frames on their way to this host, counted by the rig
    RigCounters rig_counters;  ///< counted by the rig
    RigCounters since_start;   ///< counted by the rig since its daemon started
    RigSync sync;              ///< as last reported by the rig
    RigHealth health;          ///< as last reported by the rig
    bool same_clock = false;   ///< whether the rig runs on this computer
    int own_tai_offset_s = 0;  ///< this computer's CLOCK_TAI minus UTC; the rig's is in sync
    RigStageTimes rig_times;
    Percentiles latency_ms;  ///< from exposure to decoded
    Percentiles network_ms;  ///< from published by the rig to received here, by the stage's clock
    Percentiles decode_ms;   ///< per message
    std::string last_error;
    bool by_datagrams = false;     ///< whether its frames come over SRT; if not, over TCP
    std::string datagram_trouble;  ///< why they do not although the rig offers it; empty: none
};

struct ReceiverStatus {
    std::vector<RigStatus> rigs;
    std::uint64_t sets = 0;                 ///< frame sets closed, with at least one rig
    std::uint64_t complete_frame_sets = 0;  ///< with all rigs
    std::uint64_t frame_sets_dropped =
        0;  ///< closed frame sets that newer ones replaced before next() returned them
    std::optional<MonotonicTime> newest_frame_set;  ///< when the last of them was closed
};

/// The state of a rig that the stage file names no longer.
inline constexpr const char* removed_rig = "removed from the stage";

inline constexpr const char* clocks_not_disciplined = "clocks not disciplined: skew unknown";

/// Describes the rig's clock relative to the stage's: PTP's offset and path delay, or
/// clocks_not_disciplined with the reason, and a difference in their TAI offsets.
std::string clock_text(const RigStatus& rig);

/// Describes the last step of the rig's clock; empty if there was none since its start. A step
/// below the latency budget shows nowhere else: frames still join frame sets, of the wrong pulses.
std::string clock_step_text(const RigSync& sync);

/// A warning if rig and host have different offsets of CLOCK_TAI from UTC; empty if they agree.
/// They then number the same pulse differently, however well PTP synchronises their clocks.
std::string tai_warning(const RigStatus& rig);

/// A warning if the rig's configured rate differs from the stage's; empty if they agree. Its frames
/// then never join another rig's.
std::string rate_warning(const RigStatus& rig);

/// Why the rig contributes no frames, as far as the host knows: removed, refused, unreachable,
/// silent, or out of step. Empty for a rig that contributes.
std::string trouble_of(const RigStatus& rig);

/// Whether the rig's frames join frame sets: nothing is wrong with it, or only its rate while no
/// rig of the stage films at the stage's rate (see StageStep).
bool gives_pictures(const RigStatus& rig, const std::vector<RigStatus>& rigs);

}  // namespace vantage
