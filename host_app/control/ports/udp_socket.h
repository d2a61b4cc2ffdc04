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

/// The first address of the place. Throws Error, naming `what`, for a name that does not resolve.
SocketAddress resolve(const NetworkPlace& place, const std::string& what);

/// A UDP socket that never waits when it sends.
class UdpSocket {
  public:
    /// Listens at every address of the place, IPv4 and IPv6; a group of multicast it joins on every
    /// network of this computer. Throws Error, naming `what` and the addresses, if the place is
    /// taken or the group cannot be joined.
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
    struct Listener {
        UniqueFd fd;
        int family = 0;
        std::uint32_t last_overrun = 0;
    };
    UdpSocket() = default;
    std::optional<Datagram> receive_from(Listener& listener);

    std::vector<Listener> listeners_;
    std::size_t next_ = 0;  ///< that is looked at first, so that none waits for another
    std::string what_;
    std::uint64_t overrun_ = 0;
    std::array<std::byte, 65536> buffer_{};
};

}  // namespace vantage
