#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// "tcp://HOST:PORT". HOST is an address, a name, "[v6 address]" or "*" (all interfaces, to bind
/// only); PORT is a number, or "*" to bind to a free one.
struct Endpoint {
    std::string host, port;
    /// Reached from this computer only: 127.0.0.0/8, [::1] or localhost.
    bool loopback = false;
    bool ipv6 = false;

    std::string text() const { return "tcp://" + host + ":" + port; }
};

/// Throws Error, naming `key` (of the configuration), for what is no such endpoint.
Endpoint parse_endpoint(std::string_view text, std::string_view key);

}  // namespace vantage
