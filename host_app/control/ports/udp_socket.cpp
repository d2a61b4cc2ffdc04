#include "host_app/control/ports/udp_socket.h"

#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/base/error.h"

namespace vantage {
namespace {

/// What waits in the kernel is old: a short row of messages is enough.
constexpr int receive_buffer_bytes = 1 << 16;

in_port_t& port_of(SocketAddress& address) {
    return address.bytes.ss_family == AF_INET6
               ? reinterpret_cast<sockaddr_in6&>(address.bytes).sin6_port
               : reinterpret_cast<sockaddr_in&>(address.bytes).sin_port;
}

}  // namespace

bool SocketAddress::operator==(const SocketAddress& other) const { return text() == other.text(); }

SocketAddress SocketAddress::with_port(std::uint16_t port) const {
    SocketAddress address = *this;
    port_of(address) = htons(port);
    return address;
}

std::string SocketAddress::text() const {
    char host[NI_MAXHOST] = "?", port[NI_MAXSERV] = "?";
    getnameinfo(reinterpret_cast<const sockaddr*>(&bytes), size, host, sizeof host, port,
                sizeof port, NI_NUMERICHOST | NI_NUMERICSERV);
    return fmt::format("{}:{}", host, port);
}

SocketAddress resolve(const NetworkPlace& place, const std::string& what) {
    std::string host = place.host;
    if (host.starts_with('[')) host = host.substr(1, host.size() - 2);
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_DGRAM;
    const int error = getaddrinfo(host.c_str(), std::to_string(place.port).c_str(), &hints, &found);
    if (error != 0) fail("{}: nobody knows the host {} ({})", what, host, gai_strerror(error));
    SocketAddress address;
    address.size = found->ai_addrlen;
    std::memcpy(&address.bytes, found->ai_addr, found->ai_addrlen);
    freeaddrinfo(found);
    return address;
}

UdpSocket::UdpSocket(int family)
    : fd_(::socket(family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    if (!fd_) fail("no UDP socket can be had: {}", std::strerror(errno));
}

UdpSocket UdpSocket::bound(const NetworkPlace& place, const std::string& what) {
    const SocketAddress address = resolve(place, what);
    UdpSocket socket(address.bytes.ss_family);
    socket.what_ = what;
    const int on = 1;
    setsockopt(socket.fd_.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes,
               sizeof receive_buffer_bytes);
    setsockopt(socket.fd_.get(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    if (::bind(socket.fd_.get(), reinterpret_cast<const sockaddr*>(&address.bytes), address.size) !=
        0)
        fail("{}: cannot listen on port {} ({}); choose another, or end what has it", what,
             place.port, std::strerror(errno));
    return socket;
}

UdpSocket UdpSocket::sending(const SocketAddress& to) { return UdpSocket(to.bytes.ss_family); }

std::optional<UdpSocket::Datagram> UdpSocket::receive(std::chrono::milliseconds most) {
    pollfd waiting{fd_.get(), POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(most.count())) <= 0) return std::nullopt;
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
    const ssize_t size = ::recvmsg(fd_.get(), &header, 0);
    if (size < 0) {
        // A peer that is gone says so at the next call; that is no fault of this socket.
        if (errno == EAGAIN || errno == EINTR || errno == ECONNREFUSED) return std::nullopt;
        fail("{} has failed: {}", what_, std::strerror(errno));
    }
    for (const cmsghdr* c = CMSG_FIRSTHDR(&header); c;
         c = CMSG_NXTHDR(&header, const_cast<cmsghdr*>(c)))
        if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL) {
            std::uint32_t count = 0;
            std::memcpy(&count, CMSG_DATA(c), sizeof count);
            overrun_ += static_cast<std::uint32_t>(count - last_overrun_);
            last_overrun_ = count;
        }
    datagram.from.size = header.msg_namelen;
    datagram.bytes = std::span<const std::byte>(buffer_).first(static_cast<std::size_t>(size));
    return datagram;
}

bool UdpSocket::send(std::span<const std::byte> bytes, const SocketAddress& to) const {
    return ::sendto(fd_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                    reinterpret_cast<const sockaddr*>(&to.bytes),
                    to.size) == static_cast<ssize_t>(bytes.size());
}

}  // namespace vantage
