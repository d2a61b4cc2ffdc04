#include "host_app/setup/pairing_call.h"

#include "common/base/error.h"
#include "common/config/endpoint.h"
#include "common/wire/limits.h"
#include "common/wire/zmq_helpers.h"

namespace vantage {
namespace {

/// Time for the last message to leave.
constexpr std::chrono::seconds linger{2};

}  // namespace

PairingCall::PairingCall(const std::string& endpoint, const CurveKeys& keys,
                         const std::string& name, const Limits& limits)
    : endpoint_(endpoint),
      limits_(limits),
      pairing_(keys, name),
      end_(MonotonicClock::now() + limits.answer_in),
      socket_(context_, zmq::socket_type::dealer) {
    socket_.set(zmq::sockopt::linger, option_ms(linger));
    socket_.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(max_header_bytes));
    socket_.set(zmq::sockopt::ipv6, parse_endpoint(endpoint, "--rig").ipv6);
    try {
        socket_.connect(endpoint);
    } catch (const zmq::error_t& error) {
        fail("cannot connect to {}: {}", endpoint, error.what());
    }
    send(pairing_.commit());
}

void PairingCall::turn(MonotonicTime now) {
    zmq::message_t part;
    while (socket_.recv(part, zmq::recv_flags::dontwait)) {
        if (part.more() || socket_.get(zmq::sockopt::rcvmore))
            fail("{} sent a pairing message of several parts", endpoint_);
        if (const auto answer = pairing_.hear(decode_pair_message(bytes_of(part)))) {
            send(*answer);
            end_ = now + limits_.compare_in;
        }
    }
    if (is_agreed() || now < end_) return;
    // Otherwise the commitment would be delivered when a rig listens there later.
    if (!pairing_.code()) {
        socket_.set(zmq::sockopt::linger, 0);
        fail(
            "nothing pairs at {}; open the rig for pairing with: sudo vantage-rig pair (and let "
            "TCP port {} through its firewall)",
            endpoint_, parse_endpoint(endpoint_, "--rig").port);
    }
    refuse("the codes were not compared in time");
    fail("{} was not paired in time: both sides have to confirm the code", rig().rig);
}

std::optional<std::string> PairingCall::to_compare() const {
    return pairing_.is_confirmed() ? std::nullopt : pairing_.code();
}

void PairingCall::confirm() { send(pairing_.confirm()); }

void PairingCall::send(const PairMessage& message) {
    const std::vector<std::byte> bytes = encode(message);
    socket_.send(zmq::buffer(bytes), zmq::send_flags::dontwait);
}

}  // namespace vantage
