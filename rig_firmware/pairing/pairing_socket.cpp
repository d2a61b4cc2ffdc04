#include "rig_firmware/pairing/pairing_socket.h"

#include <array>
#include <cerrno>
#include <iterator>
#include <zmq_addon.hpp>

#include "common/base/error.h"
#include "common/config/endpoint.h"
#include "common/wire/limits.h"
#include "common/wire/zmq_helpers.h"

namespace vantage {
namespace {

constexpr int messages_per_turn = 16, messages_waiting = 32;
constexpr std::chrono::seconds handshake_limit{5};
/// For the last word to leave.
constexpr std::chrono::seconds linger{2};

}  // namespace

PairingSocket::PairingSocket(const std::string& endpoint)
    : socket_(context_, zmq::socket_type::router) {
    const Endpoint wanted = parse_endpoint(endpoint, "--bind");
    socket_.set(zmq::sockopt::linger, option_ms(linger));
    socket_.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(max_header_bytes));
    socket_.set(zmq::sockopt::rcvhwm, messages_waiting);
    socket_.set(zmq::sockopt::sndhwm, messages_waiting);
    socket_.set(zmq::sockopt::handshake_ivl, option_ms(handshake_limit));
    socket_.set(zmq::sockopt::ipv6, wanted.ipv6);
    try {
        socket_.bind(wanted.text());
    } catch (const zmq::error_t& error) {
        if (error.num() == EADDRINUSE)
            fail(
                "port {} of {} is in use: end the other vantage-rig pair, or choose another port "
                "with --bind",
                wanted.port, wanted.host);
        fail("--bind {} cannot be bound: {}", endpoint, error.what());
    }
}

void PairingSocket::serve(PairingWindow& window, MonotonicTime now) {
    for (int i = 0; i < messages_per_turn; ++i) {
        std::vector<zmq::message_t> parts;
        if (!zmq::recv_multipart(socket_, std::back_inserter(parts), zmq::recv_flags::dontwait))
            return;
        const std::string route = parts.front().to_string();
        if (const std::string address = property_of(parts.back(), "Peer-Address"); !address.empty())
            peer_address_ = address;
        try {
            if (parts.size() != 2) fail("a pairing message of {} parts came", parts.size() - 1);
            send(window.hear(route, decode_pair_message(bytes_of(parts[1])), now));
        } catch (const Error& error) {
            send(window.hear_nonsense(route, error.what(), now));
        }
    }
}

void PairingSocket::send(const std::vector<PairingWindow::Outgoing>& messages) {
    for (const PairingWindow::Outgoing& outgoing : messages) {
        const std::vector<std::byte> bytes = encode(outgoing.message);
        const std::array<zmq::const_buffer, 2> parts{zmq::buffer(outgoing.route),
                                                     zmq::buffer(bytes)};
        zmq::send_multipart(socket_, parts, zmq::send_flags::dontwait);
    }
}

}  // namespace vantage
