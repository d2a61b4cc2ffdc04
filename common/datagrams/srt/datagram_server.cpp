#include "common/datagrams/datagram_server.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/datagrams/srt/srt_socket.h"
#include "common/wire/random_id.h"

namespace vantage {
namespace {

/// Handshakes that wait to be accepted.
constexpr int waiting_connections = 16;

/// 256 bits.
std::string new_passphrase() {
    std::string text;
    for (int i = 0; i < 4; ++i) text += fmt::format("{:016x}", random_id());
    return text;
}

}  // namespace

DatagramServer::DatagramServer(const std::vector<SocketAddress>& addresses, std::string rig,
                               const std::string& option)
    : rig_(std::move(rig)) {
    try {
        for (const SocketAddress& address : addresses)
            listeners_.push_back(
                listen_at(port_ == 0 ? address : address.with_port(port_), option));
        arrivals_ = srt_epoll_create();
        constexpr int events = SRT_EPOLL_IN;
        for (const int listener : listeners_)
            if (srt_epoll_add_usock(arrivals_, listener, &events) != 0)
                fail("SRT's listener cannot be polled: {}", srt_getlasterror_str());
    } catch (...) {
        close_listeners();
        throw;
    }
}

void DatagramServer::close_listeners() {
    // SRT calls admit() no more once its sockets are closed.
    for (const int listener : listeners_) srt_close(listener);
    if (arrivals_ >= 0) srt_epoll_release(arrivals_);
}

DatagramServer::~DatagramServer() {
    close_listeners();
    for (auto& [link, host] : hosts_) withdraw(host);
}

int DatagramServer::listen_at(const SocketAddress& address, const std::string& option) {
    const int listener = make_srt_socket();
    const int v6_only = address.family() == AF_INET6 && !address.is_any();
    const bool is_bound = srt_setsockflag(listener, SRTO_IPV6ONLY, &v6_only, sizeof v6_only) == 0 &&
                          srt_bind(listener, address.get(), static_cast<int>(address.size)) == 0 &&
                          srt_listen_callback(listener, &DatagramServer::admit, this) == 0 &&
                          srt_listen(listener, waiting_connections) == 0;
    if (!is_bound) {
        const std::string reason = srt_getlasterror_str();
        srt_close(listener);
        fail(
            "UDP port {} cannot be bound for {} = \"srt\": {}; end the program that uses it, or "
            "choose another port in stream.bind",
            address.text(), option, reason);
    }
    if (port_ == 0) port_ = bound_srt_address(listener).port();
    return listener;
}

int DatagramServer::admit(void* server, int socket, int, const sockaddr*, const char* name) {
    auto& self = *static_cast<DatagramServer*>(server);
    const std::lock_guard lock(self.mutex_);
    const auto offer = self.offers_.find(name ? name : "");
    const bool is_offered = offer != self.offers_.end() &&
                            srt_setsockflag(socket, SRTO_PASSPHRASE, offer->second.data(),
                                            static_cast<int>(offer->second.size())) == 0;
    if (is_offered) return 0;
    ++self.refused_;
    return -1;
}

std::vector<DatagramServer::Road> DatagramServer::serve(const std::vector<Peer>& peers,
                                                        MonotonicTime now) {
    for (auto entry = hosts_.begin(); entry != hosts_.end();) {
        const bool stays = std::any_of(peers.begin(), peers.end(),
                                       [&](const Peer& peer) { return peer.link == entry->first; });
        if (!stays) withdraw(entry->second);
        entry = stays ? std::next(entry) : hosts_.erase(entry);
    }
    accept_all(now);
    now_ = now;
    std::vector<Road> roads;
    for (const Peer& peer : peers) {
        Host& host = hosts_[peer.link];
        host.name = peer.host;
        if (host.socket >= 0) watch(host, now);
        if (host.offer.id != 0 && peer.answer.offer == host.offer.id &&
            !peer.answer.trouble.empty())
            end(host, peer.answer.trouble, now);
        if (host.offer.id == 0 && now >= host.retry) make_offer(host);
        tell_trouble(host, now);
        roads.push_back({host.offer, host.socket >= 0, host.room_bytes, host.trouble});
    }
    return roads;
}

void DatagramServer::tell_trouble(Host& host, MonotonicTime now) {
    // The road of a host that leaves ends just before the host is gone.
    if (!host.untold || now - *host.untold < liveness_limit) return;
    host.untold.reset();
    log_warning("rig {}: frames go to {} over TCP because {}; SRT is offered again every {} s",
                rig_, host.name, host.trouble, retry_period.count());
}

void DatagramServer::make_offer(Host& host) {
    host.offer = {random_id(), port_, new_passphrase()};
    const std::lock_guard lock(mutex_);
    offers_.emplace(srt_stream_name(host.offer.id), host.offer.passphrase);
}

void DatagramServer::accept_all(MonotonicTime now) {
    // Asked first, since libsrt logs an error where no connection waits.
    SRT_EPOLL_EVENT ready[waiting_connections];
    while (true) {
        const int count = srt_epoll_uwait(arrivals_, ready, waiting_connections, 0);
        if (count <= 0) return;
        for (int i = 0; i < std::min(count, waiting_connections); ++i) {
            const int socket = srt_accept(ready[i].fd, nullptr, nullptr);
            if (socket == SRT_INVALID_SOCK) return;
            take_on(socket, now);
        }
    }
}

void DatagramServer::take_on(int socket, MonotonicTime now) {
    char name[64] = {};
    int bytes = sizeof name - 1;
    (void)srt_getsockflag(socket, SRTO_STREAMID, name, &bytes);
    const auto entry = std::find_if(hosts_.begin(), hosts_.end(), [&](const auto& each) {
        return each.second.socket < 0 && each.second.offer.id != 0 &&
               srt_stream_name(each.second.offer.id) == name;
    });
    if (entry == hosts_.end()) {
        srt_close(socket);
        return;
    }
    Host& host = entry->second;
    host.socket = socket;
    host.opened = host.moved = now;
    host.packets = host.acknowledged = 0;
    host.under_way.clear();
    host.trouble.clear();
    host.untold.reset();
    {
        const std::lock_guard lock(mutex_);
        offers_.erase(name);
    }
    log_info("rig {}: frames go to {} over SRT", rig_, host.name);
}

void DatagramServer::watch(Host& host, MonotonicTime now) {
    std::size_t waiting = 0, bytes = 0;
    const bool is_connected = srt_getsockstate(host.socket) == SRTS_CONNECTED &&
                              srt_getsndbuffer(host.socket, &waiting, &bytes) != SRT_ERROR;
    if (!is_connected) {
        end(host, "the connection over SRT broke", now);
        return;
    }
    const std::uint64_t acknowledged =
        host.packets - std::min<std::uint64_t>(waiting, host.packets);
    if (waiting == 0 || acknowledged != host.acknowledged) host.moved = now;
    host.acknowledged = acknowledged;
    while (!host.under_way.empty() && host.under_way.front().first <= acknowledged)
        host.under_way.pop_front();
    const bool is_behind =
        !host.under_way.empty() && now - host.under_way.front().second > oldest_under_way;
    // Only whole messages are sent, and their last packets may be short.
    const std::size_t room = srt_buffer_packets - std::min(waiting, srt_buffer_packets);
    host.room_bytes = is_behind ? 0 : room * packet_bytes * 9 / 10;
    if (now - host.moved > stall_limit)
        end(host,
            fmt::format("no datagram of {} bytes was acknowledged for {} s: check the firewalls "
                        "and the MTU on the way",
                        packet_bytes, stall_limit.count()),
            now);
}

void DatagramServer::end(Host& host, std::string trouble, MonotonicTime now) {
    const bool has_worked = host.socket >= 0 && now - host.opened > retry_period;
    if (host.trouble.empty()) host.untold = now;
    withdraw(host);
    host.trouble = std::move(trouble);
    host.retry = has_worked ? now : now + retry_period;
}

void DatagramServer::withdraw(Host& host) {
    if (host.socket >= 0) srt_close(std::exchange(host.socket, -1));
    const std::lock_guard lock(mutex_);
    offers_.erase(srt_stream_name(host.offer.id));
    host.offer = {};
    host.room_bytes = 0;
}

bool DatagramServer::send(std::uint64_t link, const FrameParts& parts) {
    const auto entry = hosts_.find(link);
    if (entry == hosts_.end() || entry->second.socket < 0) return false;
    Host& host = entry->second;
    // Without an age at which SRT gives up: libsrt 1.5.1 then leaves holes in the receiver's
    // buffer that it never closes, until the buffer is full.
    constexpr int never = -1, in_order = 1;
    const bool is_sent_whole = cut_message(
        join_parts(parts, host.offer.passphrase), host.frames++,
        [&](std::span<const std::byte> packet) {
            const bool is_sent =
                srt_sendmsg(host.socket, reinterpret_cast<const char*>(packet.data()),
                            static_cast<int>(packet.size()), never, in_order) != SRT_ERROR;
            host.packets += is_sent;
            return is_sent;
        });
    host.under_way.emplace_back(host.packets, now_);
    return is_sent_whole;
}

}  // namespace vantage
