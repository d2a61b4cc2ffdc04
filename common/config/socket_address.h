#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <netinet/in.h>

namespace vantage {

/// An address on a network with its port, IPv4 or IPv6.
struct SocketAddress {
    sockaddr_storage bytes{};
    socklen_t size = 0;

    bool operator==(const SocketAddress& other) const;
    int family() const { return bytes.ss_family; }
    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&bytes); }
    /// 224.0.0.0/4 or ff00::/8.
    bool is_multicast() const;
    /// 0.0.0.0 or [::].
    bool is_any() const;
    std::uint16_t port() const;
    /// The same address with another port.
    SocketAddress with_port(std::uint16_t port) const;
    /// "127.0.0.1", "[::1]".
    std::string host() const;
    /// "127.0.0.1:5600", "[::1]:5600".
    std::string text() const;
};

/// The other end of a connected socket; empty if it has left, or is none on a network.
std::optional<SocketAddress> peer_of(int socket);

/// Returns every address of a host, in the order of the system's resolver. `host` is a name or an
/// address, with or without brackets. Throws Error for a name that does not resolve; its sentence
/// begins with `what`, unless that is empty.
std::vector<SocketAddress> resolve_all(std::string host, int port, const std::string& what = "");

/// The addresses of this computer, "eth0 10.0.0.2", for bug reports.
std::vector<std::string> own_addresses();

/// An address of a name, and the result of listening there or connecting to it.
struct ListenAttempt {
    SocketAddress address;
    int error = 0;  ///< errno; 0: it succeeded
};
/// Logs the addresses of a name at which no socket can listen, such as IPv6 on a computer without
/// it. Throws Error, naming `what` and every address, if none listens, or if one is in use by
/// another program.
void check_attempts(const std::vector<ListenAttempt>& attempts, const std::string& what);

}  // namespace vantage
