#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/files/unique_fd.h"
#include "common/config/socket_address.h"
#include "host_app/output/output_url.h"

namespace vantage {

/// The first of several addresses that this computer can send to, which has a network of that
/// family; the first of all if there is none. Names in the log the addresses before it. No datagram
/// is sent. Precondition: at least one address.
SocketAddress first_with_route(const std::vector<SocketAddress>& addresses,
                               const std::string& what);

/// Resolves a place to its first address with a route. Throws Error, with `what` as the socket's
/// name, if the name does not resolve.
SocketAddress resolve(const NetworkPlace& place, const std::string& what);

/// UDP socket that never blocks when it sends.
class UdpSocket {
  public:
    /// Binds to every address of the place, IPv4 and IPv6; joins a multicast group on every network
    /// interface. Throws Error, with `what` and the addresses, if the place is taken or the group
    /// cannot be joined.
    static UdpSocket bound(const NetworkPlace& place, const std::string& what);
    /// Creates a socket that only sends to addresses of this family.
    static UdpSocket sending(const SocketAddress& to);

    struct Datagram {
        std::span<const std::byte> bytes;  ///< valid until the next receive()
        SocketAddress from;
    };
    /// Waits for a datagram for at most this time. Throws Error if the socket has failed.
    std::optional<Datagram> receive(std::chrono::milliseconds most);
    /// Returns false if the datagram was not sent.
    bool send(std::span<const std::byte> bytes, const SocketAddress& to) const;
    /// Number of datagrams that the kernel dropped for lack of room since the socket was opened.
    std::uint64_t overrun() const { return overrun_; }

  private:
    struct Listener {
        UniqueFd fd;
        int family = 0;
        std::uint32_t last_overrun = 0;
    };
    UdpSocket() = default;
    std::optional<Datagram> receive_from(Listener& listener);

    std::vector<Listener> listeners_;
    std::size_t next_ = 0;  ///< descriptor that is checked first, so that none starves
    std::string what_;
    std::uint64_t overrun_ = 0;
    std::array<std::byte, 65536> buffer_{};
};

/// TCP server on every address of a place, with its connections. Use it from one thread.
class TcpListener {
  public:
    /// Throws Error, with `what` as the server's name, if the place is taken.
    TcpListener(const NetworkPlace& place, std::string what, std::size_t most_peers);

    /// Accepts connections and reads their bytes; waits for at most the given time. Throws Error if
    /// the socket has failed.
    struct Arrived {
        int peer = 0;       ///< unique number of the connection
        std::string bytes;  ///< empty: the connection is closed
    };
    std::vector<Arrived> receive(std::chrono::milliseconds most);
    void close(int peer);
    /// Number of connections that were refused because there were too many.
    std::uint64_t turned_away() const { return turned_away_; }

  private:
    struct Peer {
        int number = 0;
        UniqueFd fd;
    };
    void let_in();

    std::string what_;
    std::size_t most_peers_;
    std::vector<UniqueFd> fds_;  ///< one for each address
    std::vector<Peer> peers_;
    int next_number_ = 1;
    std::uint64_t turned_away_ = 0;
};

}  // namespace vantage
