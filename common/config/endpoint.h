#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// A TCP endpoint, "tcp://HOST:PORT". HOST is an address, a name, "[IPv6 address]", or "*" (all
/// interfaces, to bind only); PORT is a number, or "*" to bind to a free one.
struct Endpoint {
    std::string host, port;
    /// Whether only this computer can reach it: 127.0.0.0/8, [::1] or localhost.
    bool loopback = false;
    bool ipv6 = false;

    std::string text() const { return "tcp://" + host + ":" + port; }
};

/// Throws Error naming `key`, the configuration key, if the text is not an endpoint.
Endpoint parse_endpoint(std::string_view text, std::string_view key);

}  // namespace vantage
