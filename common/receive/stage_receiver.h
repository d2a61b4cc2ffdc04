#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/percentiles.h"
#include "common/config/stage_config.h"
#include "common/receive/frame_set.h"
#include "common/wire/link_message.h"

namespace vantage {

/// What the host knows of one rig's stream. The books balance at any moment:
///   arrived = received + undecodable (frames) + queue_dropped + being decoded
///   received = in_sets + late + duplicate + unsynchronized + out_of_step + in open sets
///   link.offered = link.sent + link.send_dropped + link.thinned + queued at the rig
///   link.sent = arrived + lost + under way          (of the present link)
struct RigStatus {
    std::string rig;
    bool connected = false;      ///< a frame or heartbeat within the last second
    std::string refused;         ///< a sentence, when the rig turned this host down
    std::uint64_t received = 0;  ///< frames decoded
    std::uint64_t undecodable =
        0;                      ///< messages refused by the decoder; the last reason in last_error
    std::uint64_t lost = 0;     ///< sent by the rig, never came: the connection broke
    std::uint64_t in_sets = 0;  ///< frames that met their set, and that set is closed
    std::uint64_t late = 0;     ///< frames that came after their set was closed
    std::uint64_t duplicate = 0;       ///< frames of a pulse this rig had delivered already
    std::uint64_t unsynchronized = 0;  ///< frames that name no pulse of the stage
    std::uint64_t out_of_step =
        0;  ///< frames of a rig that counts pulses differently from the rest
    std::uint64_t queue_dropped = 0;  ///< frames dropped because the host was busy
    LinkCounters link;         ///< of the frames on their way to this host, as the rig counts
    RigCounters rig_counters;  ///< as the rig last reported
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
    std::uint64_t complete_sets = 0;  ///< with all rigs
    std::uint64_t sets_dropped =
        0;  ///< closed and not taken by next() before newer ones pushed them out
};

inline constexpr const char* clocks_not_disciplined = "clocks not disciplined: skew unknown";

/// How far the rig's clock may be from the stage's, in words: PTP's offset and path delay, or
/// clocks_not_disciplined and why; and where both go by different numbers of TAI's seconds.
std::string clock_text(const RigStatus& rig);

/// Empty where rig and host have the same offset of CLOCK_TAI from UTC. Where not, they number the
/// same pulse differently, however well PTP keeps their clocks together.
std::string tai_worry(const RigStatus& rig);

/// Connects to all rigs of a stage, decodes their frames on threads of its own, and joins them by
/// trigger index. Rigs may come, go and come back at any time. A host that is slower than its rigs
/// makes them drop, oldest first, before anything crosses the network. Thread-safe.
class StageReceiver {
  public:
    enum class Purpose {
        film,       ///< asks every rig for its frames and starts the stage's take
        calibrate,  ///< as film, but for raw pairs instead of views
        look_on     ///< asks for none until ask() does, and leaves the take to the host that films
    };

    /// Throws Error if a key or an endpoint is unusable.
    explicit StageReceiver(const StageConfig& stage, Purpose purpose = Purpose::film);
    ~StageReceiver();

    /// The next closed set, oldest first, within bounded memory; empty when the time is up.
    std::optional<FrameSet> next(std::chrono::nanoseconds timeout);
    ReceiverStatus status() const;

    /// Asks a rig to send nothing (streaming = false), or only every rate_divisor-th pulse. Throws
    /// Error for a rig that is not of the stage or a divisor outside 1..max_rate_divisor.
    void ask(std::string_view rig, bool streaming, std::uint32_t rate_divisor);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
