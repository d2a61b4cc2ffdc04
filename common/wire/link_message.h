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

/// A host's request for frames of the rig's own recording.
struct FetchRequest {
    std::uint64_t id = 0;                        ///< random, not 0; a new id starts again
    std::uint64_t from_pulse = 0, to_pulse = 0;  ///< `to_pulse` is not included
    std::uint64_t granted = 0;                   ///< total frames that may be sent for this id

    bool operator==(const FetchRequest&) const = default;
};

/// The rig's answer to it.
struct FetchState {
    std::uint64_t id = 0;
    std::uint64_t sent = 0;
    bool is_over = false;  ///< all recorded frames of these pulses are sent
    std::string trouble;   ///< why it cannot be served, in a sentence; empty: none

    bool operator==(const FetchState&) const = default;
};

/// A rig's offer to one host of a road of datagrams (SRT) for its frames, for one connection.
struct DatagramOffer {
    std::uint64_t id = 0;    ///< random; 0: none at present
    std::uint16_t port = 0;  ///< UDP, at the address of the TCP connection
    std::string passphrase;  ///< in heartbeats only; else empty

    bool operator==(const DatagramOffer&) const = default;
};

/// The host's answer to it.
struct DatagramAnswer {
    std::uint64_t offer = 0;  ///< id of the offer that it tried last; 0: none
    std::string trouble;      ///< why the road did not open or ended, in a sentence; empty: none

    bool operator==(const DatagramAnswer&) const = default;
};

/// A host's message to a rig: its complete request, sent on every change and as a heartbeat.
struct HostMessage {
    std::uint64_t host_id = 0;        ///< random per receiver, not 0
    std::uint64_t link = 0;           ///< the link that `handled` refers to; 0: none yet
    std::uint64_t handled = 0;        ///< frames of that link that the host has finished with
    std::uint32_t credit_window = 1;  ///< 1..max_datagram_credit_window frames beyond those
    bool streaming = true;
    std::uint32_t rate_divisor = 1;  ///< 1..max_rate_divisor; asks for its multiples only
    std::uint64_t first_pulse = 0;   ///< of the take; 0: not announced yet
    bool raw_pairs = false;          ///< asks for sensor images instead of views
    std::optional<FetchRequest> fetch = {};
    std::uint64_t report_id = 0;           ///< random: asks for a report; 0: none
    std::optional<int> tai_offset_s = {};  ///< of the host's clock; empty: not reported
    DatagramAnswer datagrams = {};

    bool operator==(const HostMessage&) const = default;
};

/// The state of the rig's computer and calibration, and its refused connections.
struct RigHealth {
    std::optional<float> temperature_c;       ///< of its hottest sensor; empty: no sensor
    bool under_voltage = false;               ///< the computer reports a weak supply
    float captured_hz = 0, published_hz = 0;  ///< over the last seconds
    std::string calibration_id;
    std::string calibration_date;           ///< ISO 8601; empty: not from a file
    float calibration_row_rms_px = 0;       ///< row error after rectification at calibration
    std::string program_version;            ///< of the daemon, "0.2.0"; empty: not reported
    std::uint64_t refused_connections = 0;  ///< not from hosts, at the rig and at relays
    /// Step of the start-up before the rig can send frames, "compiling shaders, 7 of 21"; empty
    /// when it is ready.
    std::string starting;
    std::string keeps;  ///< one line about the rig's own recording and its erasures; empty: none

    bool operator==(const RigHealth&) const = default;
};

/// A rig's message to a host: alone as a heartbeat or refusal, and before each frame.
struct RigMessage {
    std::string rig;
    std::uint64_t session = 0;
    std::uint64_t link = 0;  ///< random per attached host; 0 in a refusal
    LinkCounters counters;   ///< of this link; `sent` numbers the frame that follows
    RigCounters rig_counters;
    RigSync sync;
    RigHealth health;
    std::optional<FetchState> fetch;
    std::uint64_t report_id = 0;  ///< of the report that follows; 0: none
    std::string refusal;          ///< why the rig does not serve this host; empty: it does
    bool refusal_passes = false;  ///< temporary: a relay does not reach the rig
    DatagramOffer offer;
    std::uint64_t sent_by_datagrams = 0;  ///< of counters.sent
    std::string datagram_trouble;  ///< why an offered road is not used, in a sentence; empty: none
};

/// Decoders take untrusted bytes. They throw Error with one sentence if a message is truncated,
/// oversized, of another schema version, or out of range.
std::vector<std::byte> encode(const HostMessage& message);
HostMessage decode_host_message(std::span<const std::byte> part);

std::vector<std::byte> encode(const RigMessage& message);
RigMessage decode_rig_message(std::span<const std::byte> part);

/// Both ends send at least this often...
inline constexpr std::chrono::milliseconds heartbeat_period{250};
/// ...and an end that is silent for this long counts as disconnected.
inline constexpr std::chrono::milliseconds liveness_limit{1000};

}  // namespace vantage
