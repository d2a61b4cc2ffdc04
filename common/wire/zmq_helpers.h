#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <vector>
#include <zmq.hpp>

namespace vantage {

std::span<const std::byte> bytes_of(const zmq::message_t& part);

/// A property of a message ("User-Id", "Peer-Address"); empty if unknown.
std::string property_of(zmq::message_t& part, const char* name);

/// Waits until one of the items is ready, the timeout is over or a signal comes. A negative timeout
/// does not wait.
void wait_for(std::vector<zmq::pollitem_t>& items, std::chrono::nanoseconds timeout);

/// Converts to ZeroMQ's option type, an int in milliseconds.
int option_ms(std::chrono::milliseconds duration);

/// The silence of the other end's computer after which a connection is closed.
inline constexpr std::chrono::milliseconds dead_connection_limit{3000};

/// Makes ZeroMQ detect dead connections (power cut, pulled cable).
void watch_for_dead_connections(zmq::socket_t& socket);

}  // namespace vantage
