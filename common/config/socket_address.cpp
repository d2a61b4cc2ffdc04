#include "common/config/socket_address.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <sys/socket.h>

#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {
namespace {

const sockaddr_in& v4_of(const SocketAddress& address) {
    return reinterpret_cast<const sockaddr_in&>(address.bytes);
}
const sockaddr_in6& v6_of(const SocketAddress& address) {
    return reinterpret_cast<const sockaddr_in6&>(address.bytes);
}

}  // namespace

bool SocketAddress::operator==(const SocketAddress& other) const { return text() == other.text(); }

bool SocketAddress::is_multicast() const {
    return family() == AF_INET6 ? IN6_IS_ADDR_MULTICAST(&v6_of(*this).sin6_addr)
                                : IN_MULTICAST(ntohl(v4_of(*this).sin_addr.s_addr));
}

bool SocketAddress::is_any() const {
    return family() == AF_INET6 ? IN6_IS_ADDR_UNSPECIFIED(&v6_of(*this).sin6_addr)
                                : v4_of(*this).sin_addr.s_addr == htonl(INADDR_ANY);
}

std::uint16_t SocketAddress::port() const {
    return ntohs(family() == AF_INET6 ? v6_of(*this).sin6_port : v4_of(*this).sin_port);
}

SocketAddress SocketAddress::with_port(std::uint16_t port) const {
    SocketAddress address = *this;
    if (family() == AF_INET6)
        reinterpret_cast<sockaddr_in6&>(address.bytes).sin6_port = htons(port);
    else
        reinterpret_cast<sockaddr_in&>(address.bytes).sin_port = htons(port);
    return address;
}

std::string SocketAddress::host() const {
    char name[NI_MAXHOST] = "?";
    getnameinfo(get(), size, name, sizeof name, nullptr, 0, NI_NUMERICHOST);
    return family() == AF_INET6 ? fmt::format("[{}]", name) : name;
}

std::string SocketAddress::text() const {
    char port[NI_MAXSERV] = "?";
    getnameinfo(get(), size, nullptr, 0, port, sizeof port, NI_NUMERICSERV | NI_DGRAM);
    return fmt::format("{}:{}", host(), port);
}

std::optional<SocketAddress> peer_of(int socket) {
    SocketAddress address;
    address.size = sizeof address.bytes;
    auto* const bytes = reinterpret_cast<sockaddr*>(&address.bytes);
    if (::getpeername(socket, bytes, &address.size) != 0) return std::nullopt;
    if (address.family() != AF_INET && address.family() != AF_INET6) return std::nullopt;
    return address;
}

std::vector<SocketAddress> resolve_all(std::string host, int port, const std::string& what) {
    if (host.starts_with('[')) host = host.substr(1, host.size() - 2);
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
    const std::string begin = what.empty() ? "" : what + ": ";
    if (error != 0)
        fail("{}the name {} does not resolve ({}): check its spelling and this computer's DNS",
             begin, host, gai_strerror(error));
    std::vector<SocketAddress> addresses;
    for (const addrinfo* each = found; each; each = each->ai_next) {
        if (each->ai_family != AF_INET && each->ai_family != AF_INET6) continue;
        SocketAddress address;
        address.size = each->ai_addrlen;
        std::memcpy(&address.bytes, each->ai_addr, each->ai_addrlen);
        if (std::find(addresses.begin(), addresses.end(), address) == addresses.end())
            addresses.push_back(address);
    }
    freeaddrinfo(found);
    if (addresses.empty()) fail("{}the host {} has no IPv4 or IPv6 address", begin, host);
    return addresses;
}

std::vector<std::string> own_addresses() {
    std::vector<std::string> all;
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return all;
    for (const ifaddrs* each = list; each; each = each->ifa_next) {
        const int family = each->ifa_addr ? each->ifa_addr->sa_family : AF_UNSPEC;
        if (family != AF_INET && family != AF_INET6) continue;
        SocketAddress address;
        address.size = family == AF_INET6 ? sizeof(sockaddr_in6) : sizeof(sockaddr_in);
        std::memcpy(&address.bytes, each->ifa_addr, address.size);
        all.push_back(fmt::format("{} {}", each->ifa_name, address.host()));
    }
    freeifaddrs(list);
    return all;
}

void check_attempts(const std::vector<ListenAttempt>& attempts, const std::string& what) {
    bool listens = false, is_taken = false;
    std::string failures;
    for (const ListenAttempt& attempt : attempts) {
        listens = listens || attempt.error == 0;
        is_taken = is_taken || attempt.error == EADDRINUSE;
        if (attempt.error != 0)
            failures += fmt::format("{}{} ({})", failures.empty() ? "" : ", ",
                                    attempt.address.text(), std::strerror(attempt.error));
    }
    if (!listens || is_taken)
        fail("{}: cannot listen on {}; choose another port, or end the program using it", what,
             failures);
    if (!failures.empty()) log_info("{}: does not listen on {}", what, failures);
}

}  // namespace vantage
