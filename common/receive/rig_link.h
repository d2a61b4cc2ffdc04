#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "common/base/time/time.h"
#include "common/config/socket_address.h"
#include "common/config/stage_config.h"
#include "common/datagrams/datagram_link.h"
#include "common/receive/link_account.h"
#include "common/wire/curve_keys.h"
#include "common/wire/frame_codec.h"
#include "common/wire/kept_parts.h"
#include "common/wire/link_message.h"
#include "common/wire/wake_event.h"

namespace vantage {

/// The connection to one rig: connects, reconnects after a refusal, sends the host's request and
/// credit to the rig, and receives its messages. If the rig offers a road of datagrams, frames
/// come by it while it works. Used by one thread, which polls socket(), monitor() and
/// datagrams_fd().
class RigLink {
  public:
    /// A frame that is not decoded yet: a live one, or one that this host fetches.
    struct Delivery {
        RigMessage message;
        std::shared_ptr<const PackedFrame> frame;  ///< null: see `kept`
        std::shared_ptr<const KeptParts> kept;
        MonotonicTime arrival{};
        TaiTime arrival_tai{};
    };

    /// The host's request to the rig.
    struct Request {
        bool streaming = true;
        std::uint32_t rate_divisor = 1;
        std::uint64_t unhandled = 0;    ///< frames that came and are not decoded yet
        std::uint64_t first_pulse = 0;  ///< of the take; 0: not announced yet
        bool raw_pairs = false;
        std::optional<FetchRequest> fetch = {};
        std::uint64_t report_id = 0;
        bool operator==(const Request&) const = default;
    };

    struct View {
        bool connected = false;
        std::optional<MonotonicTime> heard;  ///< time of its last message
        std::uint64_t session = 0;           ///< of its daemon, in its last message
        std::string refused;
        bool refusal_passes = false;  ///< temporary: a relay does not reach the rig
        std::string last_error;
        std::uint64_t malformed = 0;  ///< messages that are not valid
        std::uint64_t lost = 0;
        std::uint64_t restarts = 0;
        LinkCounters link;         ///< summed by LinkAccount
        RigCounters rig_counters;  ///< summed by LinkAccount
        RigCounters since_start;   ///< as the rig reports them, since its daemon started
        RigSync sync;
        RigHealth health;
        std::optional<FetchState> fetch;
        std::shared_ptr<const std::string> report;  ///< the last one; null: none
        bool by_datagrams = false;                  ///< whether its road of datagrams is open
        std::string datagram_trouble;               ///< why an offered one is not; empty: none
    };

    /// Throws Error if the endpoint or a key is invalid.
    RigLink(zmq::context_t& context, const StageConfig::Rig& rig,
            const std::optional<CurveKeys>& host_keys);
    ~RigLink();
    RigLink(const RigLink&) = delete;
    RigLink& operator=(const RigLink&) = delete;

    /// The identity of this host's link to a rig, with its counts.
    struct Continuity {
        std::uint64_t host_id = 0;
        LinkAccount account;
    };
    /// Takes the place of a link to the same rig, which is given up. Call it before tick().
    void continue_from(const Continuity& former);
    Continuity continuity() const { return {host_id_, account_}; }

    zmq::socket_t& socket() { return socket_; }
    zmq::socket_t& monitor() { return monitor_; }
    /// Readable when a frame or a change of the road of datagrams waits.
    int datagrams_fd() const { return arrived_.fd(); }

    /// Processes messages up to the next frame; empty when no more are waiting.
    std::optional<Delivery> receive(MonotonicTime now);

    /// Processes events of the connection.
    void watch(MonotonicTime now);

    /// Sends the request if it changed or a heartbeat is due. Reconnects after a refusal when the
    /// retry period is over.
    void tick(const Request& request, MonotonicTime now);

    /// Connects to this address of the rig's host name, "tcp://[::1]:5600", in place of the one
    /// that ZeroMQ chose. Does nothing if it is connected to that address already.
    void use_address(const std::string& address);

    View view(MonotonicTime now) const;

  private:
    void open();
    void close();
    void refuse(std::string sentence, MonotonicTime now);
    void show_account();
    using Parts = std::vector<std::span<const std::byte>>;
    bool take_in(const Parts& parts, MonotonicTime now, Delivery& delivery);
    bool take_in_datagrams(const Parts& parts, MonotonicTime now, Delivery& delivery);
    std::optional<Delivery> receive_datagrams(MonotonicTime now);
    /// Ends the road of datagrams of a former offer, and tries a new one once.
    void follow_offer(const DatagramOffer& offer);
    void note_malformed(const char* what, std::span<const std::byte> bytes,
                        const std::string& reason);

    zmq::context_t& context_;
    StageConfig::Rig rig_;
    std::string address_;  ///< that it connects to: the rig's endpoint, or an address of its name
    std::optional<CurveKeys> host_keys_;
    std::uint64_t host_id_;
    zmq::socket_t socket_;
    zmq::socket_t monitor_;

    std::optional<SocketAddress> peer_;        ///< of the connection over TCP
    int peer_socket_ = -1;                     ///< ZeroMQ's; below 0: not connected
    std::chrono::microseconds round_trip_{0};  ///< the shortest of this connection

    WakeEvent arrived_;
    std::unique_ptr<DatagramLink> datagrams_;  ///< of the last offer; null: none
    std::uint64_t damaged_datagrams_ = 0;      ///< already counted
    std::string rigs_trouble_;                 ///< with the road, as the rig says

    LinkAccount account_;
    View view_;
    bool gone_ = false;  ///< refused or disconnected since the last message
    std::optional<MonotonicTime> reopen_;
    MonotonicTime next_heartbeat_{};
    HostMessage told_;
    std::optional<int> own_tai_offset_s_;
};

}  // namespace vantage
