#include "host_app/control/ports/messages/rosstalk_line.h"

#include <charconv>

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

}  // namespace vantage
