#pragma once

#include <cstdint>
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
    /// The same computer, at another port.
    SocketAddress with_port(std::uint16_t port) const;
    /// "127.0.0.1", "[::1]".
    std::string host() const;
    /// With its port behind it.
    std::string text() const;
};

/// Every address of a host, which may be a name or an address, with or without brackets, in the
/// order of the system's resolver. Throws Error, naming `what`, for a host that nobody knows.
std::vector<SocketAddress> resolve_all(std::string host, int port, const std::string& what);

/// Of what could not listen anywhere: each address with its reason.
struct ListenAttempt {
    SocketAddress address;
    int error = 0;  ///< errno; 0: it listens
};
/// Logs the addresses of a name at which nothing can listen, such as IPv6 where there is none.
/// Throws Error, naming `what` and every address, if none listens or one is taken by another
/// program.
void check_attempts(const std::vector<ListenAttempt>& attempts, const std::string& what);

}  // namespace vantage
