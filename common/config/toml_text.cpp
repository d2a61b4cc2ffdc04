#include "common/config/toml_text.h"

#include <algorithm>

#include <fmt/format.h>

namespace vantage {

std::string toml_string(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + '"';
}

std::string fault_of_name(const std::string& name) {
    constexpr std::size_t longest_name = 40;
    if (name.size() > longest_name) return fmt::format("is longer than {} bytes", longest_name);
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; };
    if (std::any_of(name.begin(), name.end(), is_control))
        return "has a character that cannot be shown";
    return "";
}

}  // namespace vantage
