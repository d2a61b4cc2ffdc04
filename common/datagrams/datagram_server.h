#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/time/time.h"
#include "common/config/socket_address.h"
#include "common/datagrams/frame_packets.h"
#include "common/wire/link_message.h"

namespace vantage {

/// The rig's end of the roads of datagrams: sends frames over SRT to hosts that were offered it,
/// and to nobody else. An offer is for one connection. A host that is connected by it proves that
/// it knows the offer's passphrase, with which the packets are encrypted (AES) and sealed.
///
/// A road ends when SRT's connection breaks, when no packet is acknowledged for `stall_limit`, or
/// when the host reports a trouble. Its frames then go over TCP, and a new offer follows after
/// `retry_period`. Used by one thread, which it never blocks.
class DatagramServer {
  public:
    static constexpr std::chrono::seconds stall_limit{2};
    static constexpr std::chrono::seconds retry_period{10};
    /// While a frame is not acknowledged for this long, the road has no room: further frames wait
    /// at the rig, where newer ones replace them, and not in SRT's buffer.
    static constexpr std::chrono::milliseconds oldest_under_way{400};

    /// A host that may get frames, and its answer to the last offer.
    struct Peer {
        std::uint64_t link = 0;
        std::string host;  ///< for people
        DatagramAnswer answer;
    };
    /// The state of a host's road.
    struct Road {
        DatagramOffer offer;
        bool is_open = false;
        std::size_t room_bytes = 0;  ///< of messages that can be sent at once
        std::string trouble;         ///< why frames go over TCP; empty: they do not, or not yet
    };

    /// Listens at these UDP addresses. Port 0: a free one, which is the same at all addresses.
    /// Throws Error, naming `option`, if none can be bound or the build has no SRT.
    DatagramServer(const std::vector<SocketAddress>& addresses, std::string rig,
                   const std::string& option);
    ~DatagramServer();
    DatagramServer(const DatagramServer&) = delete;
    DatagramServer& operator=(const DatagramServer&) = delete;

    /// Admits connections, ends roads that do not work or whose host is not among the peers, and
    /// renews offers. Returns the roads of the peers in their order.
    std::vector<Road> serve(const std::vector<Peer>& peers, MonotonicTime now);

    /// Sends a frame to the host of this link. Returns false if the road does not take it whole.
    /// Precondition: message_bytes_of() its parts is at most the road's room.
    bool send(std::uint64_t link, const FrameParts& parts);

    /// UDP port; the same at all addresses.
    std::uint16_t port() const { return port_; }
    /// Number of connections refused because they were not offered. Any thread.
    std::uint64_t refused() const { return refused_; }

  private:
    struct Host {
        std::string name;
        DatagramOffer offer;
        int socket = -1;
        MonotonicTime opened{}, moved{}, retry{};
        std::uint64_t packets = 0;       ///< sent on this road
        std::uint64_t acknowledged = 0;  ///< of them
        std::uint32_t frames = 0;
        /// Frames that are not acknowledged: their last packets and when they were sent.
        std::deque<std::pair<std::uint64_t, MonotonicTime>> under_way;
        std::size_t room_bytes = 0;
        std::string trouble;
        std::optional<MonotonicTime> untold;  ///< when the trouble came that the log lacks
    };

    void close_listeners();
    int listen_at(const SocketAddress& address, const std::string& option);
    void accept_all(MonotonicTime now);
    void take_on(int socket, MonotonicTime now);
    void make_offer(Host& host);
    void watch(Host& host, MonotonicTime now);
    void tell_trouble(Host& host, MonotonicTime now);
    void end(Host& host, std::string trouble, MonotonicTime now);
    void withdraw(Host& host);
    static int admit(void* server, int socket, int version, const struct sockaddr* peer,
                     const char* name);

    const std::string rig_;
    std::uint16_t port_ = 0;
    MonotonicTime now_{};
    std::vector<int> listeners_;
    int arrivals_ = -1;                    ///< SRT's poll of the listeners
    std::map<std::uint64_t, Host> hosts_;  ///< by link
    std::atomic<std::uint64_t> refused_ = 0;
    std::mutex mutex_;                           ///< guards offers_, which a thread of SRT reads
    std::map<std::string, std::string> offers_;  ///< passphrases by the names of offers
};

}  // namespace vantage
