#include "common/config/endpoint.h"

#include <charconv>

#include <fmt/format.h>

namespace vantage {
namespace {

constexpr std::string_view tcp = "tcp://";
constexpr std::string_view ipc = "ipc://";
constexpr std::string_view z85_alphabet =
    "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?&<>()[]{}@%$#";
constexpr std::size_t z85_key_length = 40;

bool is_port(std::string_view text) {
    int port = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    return error == std::errc{} && end == text.data() + text.size() && port >= 1 && port <= 65535;
}

}  // namespace

std::string endpoint_fault(std::string_view endpoint, EndpointUse use) {
    if (endpoint.starts_with(ipc))
        return endpoint.size() > ipc.size() ? "" : "is 'ipc://' without the path of a socket";
    if (!endpoint.starts_with(tcp))
        return fmt::format("is '{}', and it must be tcp://HOST:PORT or ipc://PATH", endpoint);
    const std::string_view rest = endpoint.substr(tcp.size());
    const std::size_t colon = rest.rfind(':');
    if (colon == std::string_view::npos || colon == 0)
        return fmt::format("is '{}', and it must be tcp://HOST:PORT or ipc://PATH", endpoint);
    const std::string_view port = rest.substr(colon + 1);
    if (is_port(port) || (use == EndpointUse::bind && port == "*")) return "";
    return fmt::format("is '{}', and its port must be 1 to 65535", endpoint);
}

std::string z85_key_fault(std::string_view key) {
    if (key.size() != z85_key_length)
        return fmt::format("has {} characters, and a key in Z85 has {}", key.size(),
                           z85_key_length);
    const std::size_t strange = key.find_first_not_of(z85_alphabet);
    if (strange == std::string_view::npos) return "";
    return fmt::format("has the character '{}', which is none of Z85", key[strange]);
}

}  // namespace vantage
