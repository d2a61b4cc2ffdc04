#include "common/serve/stranger_watch.h"

#include <cstring>
#include <iterator>
#include <utility>
#include <vector>
#include <zmq_addon.hpp>

#include <netdb.h>
#include <sys/socket.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/socket_address.h"
#include "common/wire/random_id.h"

namespace vantage {
namespace {

/// Capacity of the event queue, above the events per second of a flood. When it is full, ZeroMQ's
/// I/O thread blocks and all frames stop.
constexpr int events_waiting = 200'000;
/// Bounds the events handled at a time, so that a flood of connections does not stop frames.
constexpr int events_per_turn = 256;

/// The longest time that an event may have waited when it is handled.
constexpr std::chrono::milliseconds late_look{500};

constexpr int watched_events =
    ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_HANDSHAKE_SUCCEEDED |
    ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL |
    ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;

/// The address of the other end; empty if it has left, or if its descriptor was reused.
std::string peer_address(int connection) {
    const std::optional<SocketAddress> peer = peer_of(connection);
    char host[NI_MAXHOST] = "";
    if (!peer ||
        ::getnameinfo(peer->get(), peer->size, host, sizeof host, nullptr, 0, NI_NUMERICHOST) != 0)
        return "";
    return host;
}

}  // namespace

StrangerWatch::StrangerWatch(zmq::context_t& context, zmq::socket_t& watched, std::string rig)
    : rig_(std::move(rig)), watched_(watched), events_(context, zmq::socket_type::pair) {
    const std::string events = fmt::format("inproc://strangers-{}", random_id());
    if (zmq_socket_monitor(watched_.handle(), events.c_str(), watched_events) != 0)
        fail("connections to rig {} cannot be monitored: {}", rig_, zmq_strerror(zmq_errno()));
    events_.set(zmq::sockopt::linger, 0);
    events_.set(zmq::sockopt::rcvhwm, events_waiting);
    events_.connect(events);
}

StrangerWatch::~StrangerWatch() {
    // Drain the queue first, since stopping waits for an event that is being written.
    zmq::message_t part;
    for (int i = 0; i < events_waiting && events_.recv(part, zmq::recv_flags::dontwait); ++i) {
    }
    zmq_socket_monitor(watched_.handle(), nullptr, 0);
}

void StrangerWatch::hear(zmq::message_t& part) {
    const auto connection = open_.find(zmq_msg_get(part.handle(), ZMQ_SRCFD));
    if (connection == open_.end() || connection->second.is_heard) return;
    connection->second.is_heard = true;
    if (unheard_hosts_ > 0) --unheard_hosts_;
}

void StrangerWatch::disconnect(zmq::message_t& part) const {
    const int descriptor = zmq_msg_get(part.handle(), ZMQ_SRCFD);
    const auto connection = open_.find(descriptor);
    if (connection == open_.end() || connection->second.address.empty()) return;
    // Another connection may have got the descriptor; at worst it is one from the same address,
    // which connects anew.
    if (peer_address(descriptor) == connection->second.address) ::shutdown(descriptor, SHUT_RDWR);
}

void StrangerWatch::look(MonotonicTime now) {
    for (int i = 0; i < events_per_turn; ++i) {
        std::vector<zmq::message_t> parts;
        if (!zmq::recv_multipart(events_, std::back_inserter(parts), zmq::recv_flags::dontwait))
            break;
        std::uint16_t event = 0;
        std::uint32_t value = 0;
        if (parts.empty() || parts.front().size() != sizeof event + sizeof value) continue;
        std::memcpy(&event, parts.front().data<std::byte>(), sizeof event);
        std::memcpy(&value, parts.front().data<std::byte>() + sizeof event, sizeof value);
        take_in(event, value, now);
    }
    for (std::size_t kind = 0; kind < complaints_.size(); ++kind) {
        Complaint& complaint = complaints_[kind];
        if (const auto times = complaint.limiter.count(std::exchange(complaint.fresh, 0), now))
            log_warning(
                "rig {}: refused connections that are not from a host: {}; the last, from {}, "
                "{}",
                rig_, *times, complaint.address.empty() ? "an unknown address" : complaint.address,
                reason(static_cast<Kind>(kind)));
    }
}

void StrangerWatch::take_in(std::uint16_t event, std::uint32_t value, MonotonicTime now) {
    // Only the first and the last event of a connection identify it. One ZeroMQ thread writes all
    // events. The end follows a failure at once, but may follow later after a refused key.
    switch (event) {
        case ZMQ_EVENT_ACCEPTED:
            open_[static_cast<int>(value)] = {peer_address(static_cast<int>(value)), now};
            break;
        case ZMQ_EVENT_HANDSHAKE_SUCCEEDED:
            ++unheard_hosts_;
            break;
        case ZMQ_EVENT_HANDSHAKE_FAILED_AUTH:
            ++unlisted_;
            break;
        case ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL:
            failed_ = Kind::left;
            break;
        case ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL:
            failed_ = value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH ? Kind::keyless
                      : has_keys_                                         ? Kind::forged
                                                                          : Kind::foreign;
            break;
        case ZMQ_EVENT_DISCONNECTED:
            end(static_cast<int>(value), now);
            break;
        default:
            break;
    }
}

void StrangerWatch::end(int descriptor, MonotonicTime now) {
    auto node = open_.extract(descriptor);
    std::optional<Kind> kind = std::exchange(failed_, std::nullopt);
    if (node.empty()) return;
    const Connection& connection = node.mapped();
    if (!kind) {
        if (connection.is_heard) return;
        if (unlisted_ > 0) {
            // HostAdmission has logged it, with its key.
            --unlisted_;
            ++refused_;
            return;
        }
        if (unheard_hosts_ > 0) {
            --unheard_hosts_;
            return;
        }
        // Data that does not begin like ZeroMQ's greeting ends without a failure event.
        kind = Kind::foreign;
    }
    if (kind == Kind::left && now - connection.since >= handshake_limit - late_look)
        kind = Kind::silent;
    ++refused_;
    Complaint& complaint = complaints_[static_cast<std::size_t>(*kind)];
    ++complaint.fresh;
    if (!connection.address.empty()) complaint.address = connection.address;
}

std::string StrangerWatch::reason(Kind kind) const {
    switch (kind) {
        case Kind::silent:
            return fmt::format("did not finish the handshake within {} s", handshake_limit.count());
        case Kind::left:
            return "closed the connection before the handshake";
        case Kind::keyless:
            return has_keys_ ? "connected without a key"
                             : "connected with a key, and this rig has none";
        case Kind::forged:
            return "does not have this rig's public key, or repeated or forged a handshake";
        default:
            return "does not speak Vantage's protocol";
    }
}

}  // namespace vantage
