#include "host_app/control/hid/jog_family.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "common/base/error.h"

namespace vantage {

std::string to_text(JogId id) { return fmt::format("{:04x}:{:04x}", id.vendor, id.product); }

JogId parse_jog_id(const std::string& text) {
    const auto is_hex = [&](std::size_t at) {
        return std::isxdigit(static_cast<unsigned char>(text[at])) != 0;
    };
    bool fits = text.size() == 9 && text[4] == ':';
    for (std::size_t i = 0; fits && i < text.size(); ++i) fits = i == 4 || is_hex(i);
    if (!fits)
        fail(
            "'{}' names no device: it takes the USB ids of vendor and product, such as 0b33:0020 "
            "(`vantage jog list --all` shows them)",
            text);
    const auto number = [&](std::size_t at) {
        return static_cast<std::uint16_t>(std::stoul(text.substr(at, 4), nullptr, 16));
    };
    return {number(0), number(5)};
}

std::unique_ptr<JogDecoder> make_known_decoder(JogId id) {
    for (const JogFamily& family : jog_families())
        for (const JogModel& model : family.models)
            if (model.id == id) return family.make_decoder(id);
    return nullptr;
}

bool reads(const JogFamily& family, const JogPlace& place) {
    if (place.transport != family.transport) return false;
    if (std::none_of(family.models.begin(), family.models.end(),
                     [&](const JogModel& model) { return model.id == place.id; }))
        return false;
    return family.speaks ? family.speaks(place) : place.interface_number <= 0;
}

}  // namespace vantage
