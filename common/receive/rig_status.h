#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/percentiles.h"
#include "common/base/time/time.h"
#include "common/wire/link_message.h"

namespace vantage {

/// What the host knows of one rig's stream, since it heard of the rig first and over all outages
/// and restarts of the rig since. The books balance at any moment:
///   rig_counters.captured = published + late + inside the rig
///   link.offered = link.sent + link.send_dropped + link.thinned + queued at the rig
///   link.sent = arrived + lost + under way
///   arrived = received + undecodable (frames) + queue_dropped + being decoded
///   received = in_sets + late + duplicate + unsynchronized + out_of_step + in open sets
/// but for what a rig that dies takes with it: counted or sent after its last word.
struct RigStatus {
    std::string rig;
    std::string endpoint;
    bool connected = false;      ///< a frame or heartbeat within the last second
    std::string refused;         ///< a sentence, when the rig turned this host down
    std::string unreachable;     ///< why nothing answers, when that was found out
    std::uint64_t outages = 0;   ///< times that a rig that had been connected was not
    double outage_s = 0;         ///< all of those together, up to now
    std::uint64_t restarts = 0;  ///< times that its daemon was started anew
    double stage_rate_hz = 0;    ///< what the stage asks for; the rig's own is in sync
    std::uint64_t received = 0;  ///< frames decoded
    std::uint64_t undecodable =
        0;                      ///< messages refused by the decoder; the last reason in last_error
    std::uint64_t lost = 0;     ///< sent by the rig, never came: the connection broke
    std::uint64_t in_frame_sets = 0;  ///< frames that met their set, and that set is closed
    std::uint64_t in_dropped_frame_sets = 0;  ///< of those: in sets that nobody took in time
    std::uint64_t late = 0;             ///< frames that came after their set was closed
    std::uint64_t duplicate = 0;        ///< frames of a pulse this rig had delivered already
    std::uint64_t unsynchronized = 0;   ///< frames that name no pulse of the stage
    /// Frames of a rig that counted pulses differently from the rest.
    std::uint64_t out_of_step = 0;
    bool is_out_of_step = false;      ///< it does so now
    bool names_no_pulse = false;      ///< none of its frames does any more
    bool lags = false;                ///< its frames come so late that it is not waited for
    std::uint64_t queue_dropped = 0;  ///< frames dropped because the host was busy
    LinkCounters link;         ///< of the frames on their way to this host, as the rig counts
    RigCounters rig_counters;  ///< as the rig counts
    RigCounters since_start;   ///< the same since its daemon started
    RigSync sync;              ///< as the rig last reported
    RigHealth health;          ///< as the rig last reported
    bool same_clock = false;   ///< the rig is a program on this computer
    int own_tai_offset_s = 0;  ///< of this computer's CLOCK_TAI from UTC; the rig's is in sync
    RigStageTimes rig_times;
    Percentiles latency_ms;  ///< exposure to decoded
    Percentiles network_ms;  ///< published by the rig to received here, on the stage's clock
    Percentiles decode_ms;   ///< of one message
    std::string last_error;
};

struct ReceiverStatus {
    std::vector<RigStatus> rigs;
    std::uint64_t sets = 0;           ///< closed, with at least one rig
    std::uint64_t complete_frame_sets = 0;  ///< with all rigs
    std::uint64_t frame_sets_dropped =
        0;  ///< closed and not taken by next() before newer ones pushed them out
    std::optional<MonotonicTime> newest_frame_set;  ///< when the last of them was closed
};

inline constexpr const char* clocks_not_disciplined = "clocks not disciplined: skew unknown";

/// How far the rig's clock may be from the stage's, in words: PTP's offset and path delay, or
/// clocks_not_disciplined and why; and where both go by different numbers of TAI's seconds.
std::string clock_text(const RigStatus& rig);

/// By how much the rig's clock was set last, in words; empty where it was not since it started.
/// Below the latency budget nothing else shows that: its frames still meet sets, of other pulses.
std::string clock_step_text(const RigSync& sync);

/// Empty where rig and host have the same offset of CLOCK_TAI from UTC. Where not, they number the
/// same pulse differently, however well PTP keeps their clocks together.
std::string tai_worry(const RigStatus& rig);

/// Empty where the rig was told the stage's rate. Where not, they number the same instant
/// differently, and none of its frames meets another rig's.
std::string rate_worry(const RigStatus& rig);

/// Why the rig gives nothing to the stage, as far as this host knows: it refuses, it cannot be
/// reached, it is silent, its pulses are others. Empty for a rig that gives.
std::string trouble_of(const RigStatus& rig);

/// Whether what the rig films comes into sets, as far as this host knows of the rigs of its stage:
/// nothing is wrong with it, or no more than its rate while no rig at the stage's films (see
/// StageStep).
bool gives_pictures(const RigStatus& rig, const std::vector<RigStatus>& rigs);

}  // namespace vantage
