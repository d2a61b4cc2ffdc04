#include "host_app/control/ports/tcp_listener.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/base/error.h"
#include "common/config/socket_address.h"

namespace vantage {
namespace {

constexpr std::size_t bytes_a_look = 4096;

}  // namespace

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
