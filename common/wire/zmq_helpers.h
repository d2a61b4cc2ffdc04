#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <vector>
#include <zmq.hpp>

namespace vantage {

std::span<const std::byte> bytes_of(const zmq::message_t& part);

/// What ZeroMQ knows of a message besides its bytes ("User-Id", "Peer-Address"); empty where it
/// knows nothing.
std::string property_of(zmq::message_t& part, const char* name);

/// Waits until one of the items is ready, the time is up or a signal comes; a time in the past is
/// none.
void wait_for(std::vector<zmq::pollitem_t>& items, std::chrono::nanoseconds timeout);

/// For ZeroMQ's options, which are int milliseconds.
int option_ms(std::chrono::milliseconds duration);

/// Both ends give a connection up whose other end's computer is silent for so long.
inline constexpr std::chrono::milliseconds dead_connection_limit{3000};

/// Has ZeroMQ find connections whose other end is gone without a word (power cut, pulled cable).
void watch_for_dead_connections(zmq::socket_t& socket);

}  // namespace vantage
