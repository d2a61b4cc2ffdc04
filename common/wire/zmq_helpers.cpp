#include "common/wire/zmq_helpers.h"

#include <algorithm>
#include <cerrno>

#include "common/wire/link_message.h"

namespace vantage {

std::span<const std::byte> bytes_of(const zmq::message_t& part) {
    return {part.data<std::byte>(), part.size()};
}

std::string property_of(zmq::message_t& part, const char* name) {
    const char* value = zmq_msg_gets(part.handle(), name);
    return value ? value : "";
}

void wait_for(std::vector<zmq::pollitem_t>& items, std::chrono::nanoseconds timeout) {
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(timeout);
    try {
        zmq::poll(items, std::max(wait, std::chrono::milliseconds(0)));
    } catch (const zmq::error_t& error) {
        if (error.num() != EINTR) throw;
    }
}

int option_ms(std::chrono::milliseconds duration) { return static_cast<int>(duration.count()); }

void watch_for_dead_connections(zmq::socket_t& socket) {
    socket.set(zmq::sockopt::heartbeat_ivl, option_ms(liveness_limit));
    socket.set(zmq::sockopt::heartbeat_timeout, option_ms(dead_connection_limit));
}

}  // namespace vantage
