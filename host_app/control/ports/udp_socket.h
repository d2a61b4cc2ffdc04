#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <netinet/in.h>

#include "common/base/files/unique_fd.h"
#include "host_app/output/output_url.h"

namespace vantage {

/// An address on a network with its port, IPv4 or IPv6.
struct SocketAddress {
    sockaddr_storage bytes{};
    socklen_t size = 0;

    bool operator==(const SocketAddress& other) const;
    /// The same computer, at another port.
    SocketAddress with_port(std::uint16_t port) const;
    std::string text() const;
};
/// Throws Error, naming `what`, for a host that nobody knows.
SocketAddress resolve(const NetworkPlace& place, const std::string& what);

/// A UDP socket that never waits when it sends.
class UdpSocket {
  public:
    /// Listens there. Throws Error, naming `what`, if the place is taken.
    static UdpSocket bound(const NetworkPlace& place, const std::string& what);
    /// Only sends, to places of this kind of address.
    static UdpSocket sending(const SocketAddress& to);

    struct Datagram {
        std::span<const std::byte> bytes;  ///< until the next receive()
        SocketAddress from;
    };
    /// Waits for so long at the most. Throws Error if the socket has failed.
    std::optional<Datagram> receive(std::chrono::milliseconds most);
    /// False: it did not go out.
    bool send(std::span<const std::byte> bytes, const SocketAddress& to) const;
    /// Datagrams that came and found no room, since the socket was opened.
    std::uint64_t overrun() const { return overrun_; }

  private:
    explicit UdpSocket(int family);

    UniqueFd fd_;
    std::string what_;
    std::uint64_t overrun_ = 0;
    std::uint32_t last_overrun_ = 0;
    std::array<std::byte, 65536> buffer_{};
};

}  // namespace vantage
