#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/wire/frame_message.h"

namespace vantage {

/// What a host fetches of the rig's own take: the frames of these pulses.
struct FetchRequest {
    std::uint64_t id = 0;                        ///< random, not 0; another one begins anew
    std::uint64_t from_pulse = 0, to_pulse = 0;  ///< `to_pulse` is the first that is left out
    std::uint64_t granted = 0;                   ///< frames that may be sent for this id in all

    bool operator==(const FetchRequest&) const = default;
};

/// How the rig stands to it.
struct FetchState {
    std::uint64_t id = 0;
    std::uint64_t sent = 0;
    bool is_over = false;  ///< all that the rig keeps of these pulses is sent
    std::string trouble;   ///< a sentence, when it cannot be served; else empty

    bool operator==(const FetchState&) const = default;
};

/// What a host tells a rig: its complete wish, sent again on every change and as heartbeat.
struct HostMessage {
    std::uint64_t host_id = 0;        ///< random per receiver, not 0
    std::uint64_t link = 0;           ///< the link that `handled` speaks of; 0: none yet
    std::uint64_t handled = 0;        ///< frames of that link the host is done with
    std::uint32_t credit_window = 1;  ///< 1..max_credit_window frames beyond those
    bool streaming = true;
    std::uint32_t rate_divisor = 1;  ///< 1..max_rate_divisor; only pulses whose index it divides
    std::uint64_t first_pulse = 0;   ///< of the take; 0: not announced yet
    bool raw_pairs = false;          ///< what the sensors saw instead of views
    std::optional<FetchRequest> fetch = {};
    std::uint64_t report_id = 0;  ///< random: asks for a report; 0: asks for none

    bool operator==(const HostMessage&) const = default;
};

/// How the rig's computer and its calibration are, and who knocks.
struct RigHealth {
    std::optional<float> temperature_c;       ///< the hottest of its sensors; empty: it has none
    bool under_voltage = false;               ///< the computer says that its supply sags
    float captured_hz = 0, published_hz = 0;  ///< over the last seconds
    std::string calibration_id;
    std::string calibration_date;           ///< ISO 8601; empty: not from a file
    float calibration_row_rms_px = 0;       ///< row error after rectification, when it was made
    std::string program_version;            ///< of the daemon, "0.2.0"; empty: it does not say
    std::uint64_t refused_connections = 0;  ///< of strangers, at the rig and at relays on the way
    std::string keeps;  ///< one line: what the rig keeps, and what it erased; empty: nothing

    bool operator==(const RigHealth&) const = default;
};

/// What a rig tells a host: alone as heartbeat or refusal, and before each frame, also one that is
/// fetched.
struct RigMessage {
    std::string rig;
    std::uint64_t session = 0;
    std::uint64_t link = 0;  ///< random per host that is taken on; 0 in a refusal
    LinkCounters counters;   ///< of this link; `sent` numbers the frame that follows
    RigCounters rig_counters;
    RigSync sync;
    RigHealth health;
    std::optional<FetchState> fetch;
    std::uint64_t report_id = 0;  ///< that the report which follows answers; 0: none follows
    std::string refusal;          ///< a sentence, when the rig does not serve this host; else empty
    bool refusal_passes = false;  ///< it is for now: a relay does not reach the rig
};

/// Decoders take nothing on trust: they throw Error with one sentence for what is truncated,
/// oversized, of another schema version, or out of range.
std::vector<std::byte> encode(const HostMessage& message);
HostMessage decode_host_message(std::span<const std::byte> part);

std::vector<std::byte> encode(const RigMessage& message);
RigMessage decode_rig_message(std::span<const std::byte> part);

/// Both ends send at least this often...
inline constexpr std::chrono::milliseconds heartbeat_period{250};
/// ...and an end that was silent this long counts as gone.
inline constexpr std::chrono::milliseconds liveness_limit{1000};

}  // namespace vantage
