#include "host_app/control/ports/messages/tsl_message.h"

#include <cstdint>

namespace vantage {
namespace {

constexpr std::size_t v3_bytes = 18;
constexpr unsigned v3_first_address = 0x80, v3_most_address = 126;

unsigned byte_at(std::span<const std::byte> bytes, std::size_t at) {
    return std::to_integer<unsigned>(bytes[at]);
}
unsigned word_at(std::span<const std::byte> bytes, std::size_t at) {
    return byte_at(bytes, at) | byte_at(bytes, at + 1) << 8;
}

std::optional<std::vector<TslDisplay>> decode_v3(std::span<const std::byte> bytes) {
    const unsigned head = byte_at(bytes, 0), control = byte_at(bytes, 1);
    constexpr unsigned tally_bits = 0xf, known_bits = 0x3f;
    if (head < v3_first_address || head > v3_first_address + v3_most_address ||
        (control & ~known_bits) != 0)
        return std::nullopt;
    for (std::size_t i = 2; i < bytes.size(); ++i)
        if (byte_at(bytes, i) < 0x20 || byte_at(bytes, i) > 0x7e) return std::nullopt;
    return std::vector{TslDisplay{static_cast<int>(head - v3_first_address), control & tally_bits}};
}

std::optional<std::vector<TslDisplay>> decode_v5(std::span<const std::byte> bytes) {
    // Bytes that follow these two, version, flags, screen; then displays: index, control, length of
    // the text and the text.
    constexpr std::size_t head_bytes = 6, display_head_bytes = 6;
    constexpr unsigned screen_control = 2, control_data = 0x8000;
    if (bytes.size() < head_bytes || bytes.size() > most_tsl_bytes ||
        word_at(bytes, 0) != bytes.size() - 2 || byte_at(bytes, 2) != 0)
        return std::nullopt;
    std::vector<TslDisplay> displays;
    // Of screens' own control the standard says nothing yet.
    if ((byte_at(bytes, 3) & screen_control) != 0) return displays;
    bytes = bytes.subspan(head_bytes);
    while (!bytes.empty()) {
        if (bytes.size() < display_head_bytes) return std::nullopt;
        const unsigned control = word_at(bytes, 2);
        const std::size_t text_bytes = word_at(bytes, 4);
        if ((control & control_data) != 0) return std::nullopt;
        if (text_bytes > bytes.size() - display_head_bytes) return std::nullopt;
        // Right, text and left lamp, two bits each: 0 off, 1 red, 2 green, 3 both.
        const unsigned lamps = (control | control >> 2 | control >> 4) & 3;
        displays.push_back({static_cast<int>(word_at(bytes, 0)), lamps});
        bytes = bytes.subspan(display_head_bytes + text_bytes);
    }
    return displays;
}

}  // namespace

std::optional<std::vector<TslDisplay>> decode_tsl(std::span<const std::byte> datagram) {
    // 18 bytes that begin with such an address could be no 5.0: its count of bytes would be 16.
    if (datagram.size() == v3_bytes && byte_at(datagram, 0) >= v3_first_address)
        return decode_v3(datagram);
    return decode_v5(datagram);
}

}  // namespace vantage
