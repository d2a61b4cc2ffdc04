#include "common/config/toml_edit.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "common/base/error.h"

namespace vantage {
namespace {

toml::table parse(std::string_view text, const std::filesystem::path& name) {
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        fail("{} line {} is not TOML: {}", name.string(), error.source().begin.line,
             error.description());
    }
}

/// The byte offset of a position of the parser, whose columns count characters.
std::size_t offset_of(std::string_view text, const toml::source_position& place) {
    std::size_t offset = 0;
    for (toml::source_index line = 1; line < place.line; ++line) {
        const std::size_t end = text.find('\n', offset);
        if (end == std::string_view::npos) return text.size();
        offset = end + 1;
    }
    constexpr unsigned char continuation_mask = 0xc0, continuation = 0x80;
    for (toml::source_index column = 1; column < place.column && offset < text.size(); ++column) {
        ++offset;
        while (offset < text.size() &&
               (static_cast<unsigned char>(text[offset]) & continuation_mask) == continuation)
            ++offset;
    }
    return offset;
}

/// The first byte of the line after the one with `offset`.
std::size_t after_line(std::string_view text, std::size_t offset) {
    const std::size_t end = text.find('\n', offset);
    return end == std::string_view::npos ? text.size() : end + 1;
}

std::string key_text(std::string_view key) {
    const bool is_bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '-' || c == '_';
    });
    return is_bare ? std::string(key) : toml_string(std::string(key));
}

std::string line_of(std::string_view key, std::string_view value) {
    return fmt::format("{} = {}\n", key_text(key), value);
}

std::string inserted(std::string_view text, std::size_t at, const std::string& line) {
    const bool is_open = at > 0 && text[at - 1] != '\n';
    return std::string(text.substr(0, at)) + (is_open ? "\n" : "") + line +
           std::string(text.substr(at));
}

/// The offset for a new key: below the table's header, or, at the top, below its first key.
std::optional<std::size_t> place_in(std::string_view text, const toml::table& table, bool is_top) {
    if (is_top) {
        std::optional<std::size_t> place;
        for (const auto& [key, node] : table) {
            if (node.is_table() || node.is_array_of_tables()) continue;
            const std::size_t end = after_line(text, offset_of(text, node.source().end));
            if (!place || end < *place) place = end;
        }
        return place;
    }
    const std::size_t begin = offset_of(text, table.source().begin);
    if (begin >= text.size() || text[begin] != '[') return std::nullopt;
    return after_line(text, begin);
}

const toml::table* table_at(const toml::table& top, std::string_view table) {
    return table.empty() ? &top : top.at_path(table).as_table();
}

}  // namespace

std::string with_toml_value(std::string_view text, std::string_view table, std::string_view key,
                            std::string_view value, const std::filesystem::path& name) {
    const toml::table top = parse(text, name);
    const toml::table* const in = table_at(top, table);
    if (!in && top.at_path(table)) fail("{}: '{}' is not a table", name.string(), table);
    if (!in) {
        const std::string line = fmt::format("\n[{}]\n", table) + line_of(key, value);
        return inserted(text, text.size(), line);
    }
    if (const toml::node* const node = in->get(key)) {
        const std::size_t begin = offset_of(text, node->source().begin);
        const std::size_t end = offset_of(text, node->source().end);
        return std::string(text.substr(0, begin)) + std::string(value) +
               std::string(text.substr(end));
    }
    const std::optional<std::size_t> place = place_in(text, *in, table.empty());
    if (!place)
        fail("{}: the table '{}' has no header [{}] below which '{}' could be put; write one",
             name.string(), table, table, key);
    return inserted(text, *place, line_of(key, value));
}

std::string without_toml_key(std::string_view text, std::string_view table, std::string_view key,
                             const std::filesystem::path& name) {
    const toml::table top = parse(text, name);
    const toml::table* const in = table_at(top, table);
    const toml::node* const node = in ? in->get(key) : nullptr;
    if (!node) return std::string(text);
    const std::size_t value = offset_of(text, node->source().begin);
    const std::size_t previous_end = value == 0 ? 0 : text.rfind('\n', value - 1);
    const std::size_t begin = previous_end == std::string_view::npos ? 0 : previous_end + 1;
    const std::size_t end = after_line(text, offset_of(text, node->source().end));
    return std::string(text.substr(0, begin)) + std::string(text.substr(end));
}

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
