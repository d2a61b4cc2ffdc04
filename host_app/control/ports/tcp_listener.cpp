#include "host_app/control/ports/tcp_listener.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <poll.h>
#include <sys/socket.h>

#include "common/base/error.h"
#include "host_app/control/ports/udp_socket.h"

namespace vantage {
namespace {

constexpr std::size_t bytes_a_look = 4096;

}  // namespace

TcpListener::TcpListener(const NetworkPlace& place, std::string what, std::size_t most_peers)
    : what_(std::move(what)), most_peers_(most_peers) {
    const SocketAddress address = resolve(place, what_);
    fd_ =
        UniqueFd(::socket(address.bytes.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!fd_) fail("no TCP socket can be had: {}", std::strerror(errno));
    const int on = 1;
    // A port that was in use a moment ago is free.
    setsockopt(fd_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    constexpr int backlog = 8;
    if (::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&address.bytes), address.size) != 0 ||
        ::listen(fd_.get(), backlog) != 0)
        fail("{}: cannot listen on port {} ({}); choose another, or end what has it", what_,
             place.port, std::strerror(errno));
}

void TcpListener::let_in() {
    for (;;) {
        UniqueFd fd(::accept4(fd_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
        if (!fd) return;
        if (peers_.size() >= most_peers_)
            ++turned_away_;
        else
            peers_.push_back({next_number_++, std::move(fd)});
    }
}

std::vector<TcpListener::Arrived> TcpListener::receive(std::chrono::milliseconds most) {
    std::vector<pollfd> waiting{{fd_.get(), POLLIN, 0}};
    for (const Peer& peer : peers_) waiting.push_back({peer.fd.get(), POLLIN, 0});
    if (::poll(waiting.data(), waiting.size(), static_cast<int>(most.count())) <= 0) return {};
    if ((waiting.front().revents & (POLLERR | POLLNVAL)) != 0) fail("{} has failed", what_);
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
