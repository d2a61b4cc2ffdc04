#include "common/receive/reachability.h"

#include <cerrno>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/base/files/unique_fd.h"

namespace vantage {
namespace {

/// Tries to connect to an address. Returns 0, or errno.
int try_address(const addrinfo& address, std::chrono::milliseconds limit) {
    const UniqueFd fd(::socket(address.ai_family,
                               address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC,
                               address.ai_protocol));
    if (!fd) return errno;
    if (::connect(fd.get(), address.ai_addr, address.ai_addrlen) == 0) return 0;
    if (errno != EINPROGRESS) return errno;
    pollfd wait{fd.get(), POLLOUT, 0};
    if (::poll(&wait, 1, static_cast<int>(limit.count())) <= 0) return ETIMEDOUT;
    int error = 0;
    socklen_t size = sizeof error;
    ::getsockopt(fd.get(), SOL_SOCKET, SO_ERROR, &error, &size);
    return error;
}

}  // namespace

std::string why_unreachable(const Endpoint& endpoint, std::chrono::milliseconds limit) {
    addrinfo wanted{};
    wanted.ai_family = endpoint.ipv6 ? AF_UNSPEC : AF_INET;
    wanted.ai_socktype = SOCK_STREAM;
    // IPv6 addresses are in brackets.
    const std::string host = endpoint.host.starts_with('[')
                                 ? endpoint.host.substr(1, endpoint.host.size() - 2)
                                 : endpoint.host;
    addrinfo* found = nullptr;
    if (const int error = ::getaddrinfo(host.c_str(), endpoint.port.c_str(), &wanted, &found))
        return fmt::format(
            "the name {} does not resolve ({}): check its spelling and this computer's DNS", host,
            ::gai_strerror(error));
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, &::freeaddrinfo);
    int error = 0;
    for (const addrinfo* address = found; address; address = address->ai_next)
        if (error = try_address(*address, limit); error == 0) return {};
    if (error == ECONNREFUSED)
        return fmt::format(
            "connection refused at {}: the computer is up, but vantage-rig does not run "
            "there, or uses another port",
            endpoint.text());
    if (error == ETIMEDOUT)
        return fmt::format(
            "nothing answers at {}: check that its computer is on, the cable and the firewall "
            "open?",
            endpoint.text());
    return fmt::format("{} cannot be reached: {}", endpoint.text(), std::strerror(error));
}

}  // namespace vantage
