#include "host_app/control/ports/sockets.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/socket_address.h"

namespace vantage {
namespace {

/// Size of the kernel's buffer; it is small, since waiting messages are outdated.
constexpr int receive_buffer_bytes = 1 << 16;

UniqueFd udp_fd(int family) {
    return UniqueFd(::socket(family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

bool join(int fd, const SocketAddress& group, unsigned interface) {
    if (group.family() == AF_INET6) {
        ipv6_mreq request{reinterpret_cast<const sockaddr_in6&>(group.bytes).sin6_addr, interface};
        return setsockopt(fd, IPPROTO_IPV6, IPV6_JOIN_GROUP, &request, sizeof request) == 0;
    }
    ip_mreqn request{};
    request.imr_multiaddr = reinterpret_cast<const sockaddr_in&>(group.bytes).sin_addr;
    request.imr_ifindex = static_cast<int>(interface);
    return setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) == 0;
}

/// Joins the group on every network interface that is up. Throws Error if none can join.
void join_everywhere(int fd, const SocketAddress& group, const std::string& what) {
    std::string joined;
    int error = ENODEV;
    const struct if_nameindex* const interfaces = if_nameindex();
    for (const auto* each = interfaces; each && each->if_index != 0; ++each) {
        if (join(fd, group, each->if_index))
            joined += fmt::format("{}{}", joined.empty() ? "" : ", ", each->if_name);
        else
            error = errno;
    }
    if (interfaces) if_freenameindex(const_cast<struct if_nameindex*>(interfaces));
    if (joined.empty())
        fail("{}: the group {} cannot be joined on any network of this computer ({})", what,
             group.host(), std::strerror(error));
    log_info("{}: joined the group {} on {}", what, group.host(), joined);
}

constexpr std::size_t bytes_a_look = 4096;

}  // namespace

SocketAddress first_with_route(const std::vector<SocketAddress>& addresses,
                               const std::string& what) {
    std::string others;
    for (const SocketAddress& address : addresses) {
        // Connecting a datagram socket looks the route up and sends nothing.
        const UniqueFd fd = udp_fd(address.family());
        if (fd && ::connect(fd.get(), address.get(), address.size) == 0) {
            if (!others.empty())
                log_info("{}: sends to {}, since there is no way to {}", what, address.text(),
                         others);
            return address;
        }
        others += fmt::format("{}{} ({})", others.empty() ? "" : ", ", address.text(),
                              std::strerror(errno));
    }
    return addresses.front();
}

SocketAddress resolve(const NetworkPlace& place, const std::string& what) {
    return first_with_route(resolve_all(place.host, place.port, what), what);
}

UdpSocket UdpSocket::bound(const NetworkPlace& place, const std::string& what) {
    UdpSocket socket;
    socket.what_ = what;
    const int on = 1, off = 0;
    std::vector<ListenAttempt> attempts;
    for (const SocketAddress& address : resolve_all(place.host, place.port, what)) {
        UniqueFd fd = udp_fd(address.family());
        attempts.push_back({address, fd ? 0 : errno});
        if (!fd) continue;
        setsockopt(fd.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes,
                   sizeof receive_buffer_bytes);
        setsockopt(fd.get(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
        // Several programs on this computer may listen to one group.
        if (address.is_multicast()) setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        if (address.family() == AF_INET6)
            setsockopt(fd.get(), IPPROTO_IPV6, IPV6_V6ONLY, address.is_any() ? &off : &on,
                       sizeof on);
        if (::bind(fd.get(), address.get(), address.size) != 0) {
            attempts.back().error = errno;
            continue;
        }
        if (address.is_multicast()) join_everywhere(fd.get(), address, what);
        socket.listeners_.push_back({std::move(fd), address.family(), 0});
    }
    check_attempts(attempts, what);
    return socket;
}

UdpSocket UdpSocket::sending(const SocketAddress& to) {
    UdpSocket socket;
    UniqueFd fd = udp_fd(to.family());
    if (!fd) fail("no UDP socket can be had: {}", std::strerror(errno));
    socket.listeners_.push_back({std::move(fd), to.family(), 0});
    return socket;
}

std::optional<UdpSocket::Datagram> UdpSocket::receive(std::chrono::milliseconds most) {
    std::vector<pollfd> waiting;
    for (const Listener& listener : listeners_) waiting.push_back({listener.fd.get(), POLLIN, 0});
    if (::poll(waiting.data(), waiting.size(), static_cast<int>(most.count())) <= 0)
        return std::nullopt;
    for (std::size_t i = 0; i < listeners_.size(); ++i) {
        const std::size_t at = (next_ + i) % listeners_.size();
        if (waiting[at].revents == 0) continue;
        next_ = at + 1;
        return receive_from(listeners_[at]);
    }
    return std::nullopt;
}

std::optional<UdpSocket::Datagram> UdpSocket::receive_from(Listener& listener) {
    Datagram datagram;
    iovec part{buffer_.data(), buffer_.size()};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(std::uint32_t))];
    msghdr header{};
    header.msg_name = &datagram.from.bytes;
    header.msg_namelen = sizeof datagram.from.bytes;
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = control;
    header.msg_controllen = sizeof control;
    const ssize_t size = ::recvmsg(listener.fd.get(), &header, 0);
    if (size < 0) {
        // The error of a closed peer appears at the next call and is not an error of this socket.
        if (errno == EAGAIN || errno == EINTR || errno == ECONNREFUSED) return std::nullopt;
        fail("{} has failed: {}", what_, std::strerror(errno));
    }
    for (const cmsghdr* c = CMSG_FIRSTHDR(&header); c;
         c = CMSG_NXTHDR(&header, const_cast<cmsghdr*>(c)))
        if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL) {
            std::uint32_t count = 0;
            std::memcpy(&count, CMSG_DATA(c), sizeof count);
            overrun_ += static_cast<std::uint32_t>(count - listener.last_overrun);
            listener.last_overrun = count;
        }
    datagram.from.size = header.msg_namelen;
    datagram.bytes = std::span<const std::byte>(buffer_).first(static_cast<std::size_t>(size));
    return datagram;
}

bool UdpSocket::send(std::span<const std::byte> bytes, const SocketAddress& to) const {
    for (const Listener& listener : listeners_)
        if (listener.family == to.family())
            return ::sendto(listener.fd.get(), bytes.data(), bytes.size(),
                            MSG_DONTWAIT | MSG_NOSIGNAL, to.get(),
                            to.size) == static_cast<ssize_t>(bytes.size());
    return false;
}

TcpListener::TcpListener(const NetworkPlace& place, std::string what, std::size_t most_peers)
    : what_(std::move(what)), most_peers_(most_peers) {
    constexpr int backlog = 8;
    const int on = 1, off = 0;
    std::vector<ListenAttempt> attempts;
    for (const SocketAddress& address : resolve_all(place.host, place.port, what_)) {
        UniqueFd fd(::socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
        attempts.push_back({address, fd ? 0 : errno});
        if (!fd) continue;
        // Allows a port that was in use a moment ago.
        setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        if (address.family() == AF_INET6)
            setsockopt(fd.get(), IPPROTO_IPV6, IPV6_V6ONLY, address.is_any() ? &off : &on,
                       sizeof on);
        if (::bind(fd.get(), address.get(), address.size) != 0 || ::listen(fd.get(), backlog) != 0)
            attempts.back().error = errno;
        else
            fds_.push_back(std::move(fd));
    }
    check_attempts(attempts, what_);
}

void TcpListener::let_in() {
    for (const UniqueFd& listening : fds_)
        for (;;) {
            UniqueFd fd(::accept4(listening.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
            if (!fd) break;
            if (peers_.size() >= most_peers_)
                ++turned_away_;
            else
                peers_.push_back({next_number_++, std::move(fd)});
        }
}

std::vector<TcpListener::Arrived> TcpListener::receive(std::chrono::milliseconds most) {
    std::vector<pollfd> waiting;
    for (const UniqueFd& fd : fds_) waiting.push_back({fd.get(), POLLIN, 0});
    for (const Peer& peer : peers_) waiting.push_back({peer.fd.get(), POLLIN, 0});
    if (::poll(waiting.data(), waiting.size(), static_cast<int>(most.count())) <= 0) return {};
    for (std::size_t i = 0; i < fds_.size(); ++i)
        if ((waiting[i].revents & (POLLERR | POLLNVAL)) != 0) fail("{} has failed", what_);
    std::vector<Arrived> arrived;
    std::array<char, bytes_a_look> buffer{};
    for (const Peer& peer : peers_) {
        const ssize_t size = ::recv(peer.fd.get(), buffer.data(), buffer.size(), 0);
        if (size < 0 && (errno == EAGAIN || errno == EINTR)) continue;
        arrived.push_back(
            {peer.number,
             size > 0 ? std::string(buffer.data(), static_cast<std::size_t>(size)) : ""});
    }
    for (const Arrived& each : arrived)
        if (each.bytes.empty()) close(each.peer);
    let_in();
    return arrived;
}

void TcpListener::close(int peer) {
    std::erase_if(peers_, [peer](const Peer& each) { return each.number == peer; });
}

}  // namespace vantage
