#pragma once

#include <chrono>
#include <string>

#include "common/config/endpoint.h"

namespace vantage {

/// Result of a connection that was opened and closed for a diagnosis.
struct Reachability {
    std::string address;  ///< that accepted it, "tcp://127.0.0.1:5600"; empty: none did
    std::string reason;   ///< a sentence: why none did
};

/// Tries every address of an endpoint's host, IPv4 and IPv6, in the order of the system's resolver.
/// The reason names each address: the name does not resolve, the connection is refused, or nothing
/// answers within `limit`. A name lookup may take longer than the limit.
Reachability reach(const Endpoint& endpoint, std::chrono::milliseconds limit);

}  // namespace vantage
