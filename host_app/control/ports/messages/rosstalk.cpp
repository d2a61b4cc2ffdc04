#include "host_app/control/ports/messages/rosstalk.h"

#include <charconv>

#include <fmt/format.h>

#include "common/base/cli/nearest_name.h"
#include "common/base/files/atomic_file.h"
#include "common/config/toml_reader.h"

namespace vantage {
namespace {

/// Parses a number of digits only, at least 0.
std::optional<int> number_of(std::string_view text) {
    constexpr int most = 99'999;
    int number = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, number);
    if (error != std::errc() || end != last || number < 0 || number > most || text.front() == '-')
        return std::nullopt;
    return number;
}

constexpr int map_version = 1;
constexpr std::size_t most_bytes = 1 << 20;

CommandCall read_call(TomlTable& table, const std::string& key) {
    std::string action;
    table.read(key, action);
    if (const std::optional<CommandCall> call = parse_button_command(action)) return *call;
    table.refuse(
        key, fmt::format("must not be '{}'; {}", action, suggest_name(action, button_commands())));
}

}  // namespace

RossTalkLine parse_rosstalk(std::string_view line) {
    while (line.ends_with(' ') || line.ends_with('\t')) line.remove_suffix(1);
    constexpr std::string_view gpi = "GPI ", xpt = "XPT ";
    if (line.starts_with(gpi)) {
        const auto number = number_of(line.substr(gpi.size()));
        if (!number) return {{}, true};
        return {RossTalkOrder{RossTalkOrder::Kind::gpi, *number, 0}, true};
    }
    if (!line.starts_with(xpt)) return {};
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return {{}, true};
    const auto destination = number_of(line.substr(xpt.size(), colon - xpt.size()));
    const auto source = number_of(line.substr(colon + 1));
    if (!destination || !source) return {{}, true};
    return {RossTalkOrder{RossTalkOrder::Kind::xpt, *destination, *source}, true};
}

RossTalkMap RossTalkMap::read(std::string_view text, const std::filesystem::path& name) {
    RossTalkMap map;
    const auto order_of = [](const TomlTable& table, const std::string& command,
                             const std::string& key, std::string_view wanted) {
        const RossTalkLine line = parse_rosstalk(command + key);
        if (!line.order) table.refuse(key, fmt::format("is no {}", wanted));
        return *line.order;
    };
    read_toml_text(text, name, map_version, [&](TomlTable& top) {
        top.read_table("gpi", [&](TomlTable& table) {
            for (const std::string& key : table.keys())
                map.gpi_[order_of(table, "GPI ", key, "number of a GPI, such as 3").first] =
                    read_call(table, key);
        });
        top.read_table("xpt", [&](TomlTable& table) {
            for (const std::string& key : table.keys()) {
                const RossTalkOrder order =
                    order_of(table, "XPT ", key, "destination and source, such as \"1:3\"");
                map.xpt_[{order.first, order.second}] = read_call(table, key);
            }
        });
    });
    return map;
}

RossTalkMap RossTalkMap::load(const std::filesystem::path& path) {
    if (path.empty()) {
        const EmbeddedText& standard = embedded_rosstalk().front();
        return read(standard.text, fmt::format("hw_config/rosstalk/{}", standard.name));
    }
    return read(read_text_file(path, most_bytes), path);
}

const CommandCall* RossTalkMap::find(const RossTalkOrder& order) const {
    if (order.kind == RossTalkOrder::Kind::gpi) {
        const auto found = gpi_.find(order.first);
        return found == gpi_.end() ? nullptr : &found->second;
    }
    const auto found = xpt_.find({order.first, order.second});
    return found == xpt_.end() ? nullptr : &found->second;
}

}  // namespace vantage
