#include "common/config/endpoint.h"

#include <algorithm>
#include <charconv>

#include <arpa/inet.h>

#include "common/base/error.h"

namespace vantage {
namespace {

bool is_port(std::string_view text) {
    if (text == "*") return true;
    int port = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    constexpr int highest_port = 65535;
    return error == std::errc() && end == text.data() + text.size() && port >= 1 &&
           port <= highest_port;
}

bool is_host(std::string_view text) {
    // ZeroMQ gives ';' and '/' inside an address a special meaning, so they are refused.
    return text == "*" || (!text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
               return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' ||
                      c == '_';
           }));
}

bool is_loopback_v4(const std::string& host) {
    in_addr address{};
    constexpr std::uint32_t loopback_net = 127;
    return inet_pton(AF_INET, host.c_str(), &address) == 1 &&
           ntohl(address.s_addr) >> 24 == loopback_net;
}

}  // namespace

Endpoint parse_endpoint(std::string_view text, std::string_view key) {
    const auto refuse = [&] {
        fail("{} = \"{}\" is not an endpoint of the form tcp://HOST:PORT", key, text);
    };
    constexpr std::string_view scheme = "tcp://";
    if (!text.starts_with(scheme)) refuse();
    const std::string_view rest = text.substr(scheme.size());
    const std::size_t colon = rest.rfind(':');
    if (colon == std::string_view::npos) refuse();
    Endpoint endpoint;
    endpoint.host = rest.substr(0, colon);
    endpoint.port = rest.substr(colon + 1);
    if (!is_port(endpoint.port)) refuse();
    if (endpoint.host.starts_with('[') && endpoint.host.ends_with(']')) {
        endpoint.ipv6 = true;
        in6_addr address{};
        std::string inner = endpoint.host.substr(1, endpoint.host.size() - 2);
        // A link-local address names its network device: fe80::1%eth0.
        if (const std::size_t scope = inner.find('%'); scope != std::string::npos) {
            if (!is_host(inner.substr(scope + 1))) refuse();
            inner.resize(scope);
        }
        if (inet_pton(AF_INET6, inner.c_str(), &address) != 1) refuse();
        endpoint.loopback = IN6_IS_ADDR_LOOPBACK(&address);
    } else {
        if (!is_host(endpoint.host)) refuse();
        endpoint.loopback = endpoint.host == "localhost" || is_loopback_v4(endpoint.host);
    }
    return endpoint;
}

}  // namespace vantage
