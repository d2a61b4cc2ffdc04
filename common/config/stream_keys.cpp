#include "common/config/stream_keys.h"

#include <algorithm>
#include <cctype>

#include "common/base/error.h"
#include "common/config/endpoint.h"

namespace vantage {

void read_stream_name(TomlTable& table, std::string& name) {
    constexpr std::size_t max_length = 64;
    if (name.empty()) table.require("name");
    table.read("name", name);
    if (!table.has("name")) return;
    const bool fits = std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '-' || c == '_';
    });
    if (!fits || name.empty() || name.size() > max_length)
        table.refuse("name",
                     fmt::format("is '{}', but must be 1 to {} letters, digits, '-' and '_'", name,
                                 max_length));
}

void check_endpoint(const TomlTable& table, std::string_view key, const std::string& endpoint) {
    try {
        parse_endpoint(endpoint, key);
    } catch (const Error& error) {
        fail("{}: {}", table.place(key), error.what());
    }
}

}  // namespace vantage
