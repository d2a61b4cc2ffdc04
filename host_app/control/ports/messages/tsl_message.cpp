#include "host_app/control/ports/messages/tsl_message.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace vantage {
namespace {

constexpr char dle = '\xfe', stx = '\x02';

std::size_t byte_at(const std::string& bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]);
}

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
    // The text that follows is not used, and some senders pad it with NUL.
    return std::vector{TslDisplay{static_cast<int>(head - v3_first_address), control & tally_bits}};
}

std::optional<std::vector<TslDisplay>> decode_v5(std::span<const std::byte> bytes) {
    // Header after these two bytes: version, flags, screen. Then displays: index, control, length
    // of the text, and the text.
    constexpr std::size_t head_bytes = 6, display_head_bytes = 6;
    constexpr unsigned screen_control = 2, control_data = 0x8000;
    if (bytes.size() < head_bytes || bytes.size() > most_tsl_bytes ||
        word_at(bytes, 0) != bytes.size() - 2 || byte_at(bytes, 2) != 0)
        return std::nullopt;
    std::vector<TslDisplay> displays;
    // The standard does not yet define control data of screens.
    if ((byte_at(bytes, 3) & screen_control) != 0) return displays;
    bytes = bytes.subspan(head_bytes);
    while (!bytes.empty()) {
        if (bytes.size() < display_head_bytes) return std::nullopt;
        const unsigned control = word_at(bytes, 2);
        const std::size_t text_bytes = word_at(bytes, 4);
        if ((control & control_data) != 0) return std::nullopt;
        if (text_bytes > bytes.size() - display_head_bytes) return std::nullopt;
        // Right lamp, text and left lamp, two bits each: 0 off, 1 red, 2 green, 3 both.
        const unsigned lamps = (control | control >> 2 | control >> 4) & 3;
        displays.push_back({static_cast<int>(word_at(bytes, 0)), lamps});
        bytes = bytes.subspan(display_head_bytes + text_bytes);
    }
    return displays;
}

/// Number of extra bytes of a version 4.0 message, which follow the 18 bytes of 3.1: checksum,
/// count, and that many bytes.
std::size_t v4_extra_bytes(std::span<const std::byte> bytes) {
    constexpr std::size_t extra_head_bytes = 2;
    if (bytes.size() < v3_bytes + extra_head_bytes) return 0;
    unsigned sum = 0;
    for (std::size_t i = 0; i < v3_bytes; ++i) sum += byte_at(bytes, i);
    if (byte_at(bytes, v3_bytes) != ((0x80 - (sum & 0x7f)) & 0x7f)) return 0;
    const std::size_t extra = extra_head_bytes + (byte_at(bytes, v3_bytes + 1) & 0xf);
    return v3_bytes + extra <= bytes.size() ? extra : 0;
}

/// Bytes that senders put after the last message: NUL, blanks and ends of lines.
bool is_padding(std::byte byte) {
    constexpr std::string_view padding("\0 \r\n", 4);
    return padding.find(static_cast<char>(byte)) != std::string_view::npos;
}

/// Decodes the first message and removes it from the bytes. Empty if there is none.
std::optional<std::vector<TslDisplay>> take_message(std::span<const std::byte>& bytes) {
    const bool may_be_v3 = bytes.size() >= v3_bytes && byte_at(bytes, 0) >= v3_first_address;
    const std::size_t v5_bytes = bytes.size() < 3 ? 0 : word_at(bytes, 0) + std::size_t{2};
    const bool may_be_v5 = v5_bytes > 2 && v5_bytes <= bytes.size() && byte_at(bytes, 2) == 0;
    if (may_be_v5 && (!may_be_v3 || v5_bytes == bytes.size())) {
        const auto displays = decode_v5(bytes.first(v5_bytes));
        bytes = bytes.subspan(v5_bytes);
        return displays;
    }
    if (!may_be_v3) return std::nullopt;
    const auto displays = decode_v3(bytes.first(v3_bytes));
    bytes = bytes.subspan(v3_bytes + v4_extra_bytes(bytes));
    return displays;
}

/// Decodes version 5.0 in its TCP framing, which some senders also use over UDP.
std::optional<std::vector<TslDisplay>> decode_wrapped(std::span<const std::byte> bytes) {
    TslStream stream;
    std::vector<TslDisplay> all;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::vector<std::string> messages = stream.take(text);
    for (const std::string& message : messages) {
        const auto displays = decode_v5(std::as_bytes(std::span(message)));
        if (!displays) return std::nullopt;
        all.insert(all.end(), displays->begin(), displays->end());
    }
    if (messages.empty() || stream.strays() > 0 || stream.has_rest()) return std::nullopt;
    return all;
}

}  // namespace

std::vector<std::string> TslStream::take(std::string_view bytes) {
    std::vector<std::string> whole;
    for (const char byte : bytes) {
        if (place_ == Place::bare) {
            append_bare(byte, whole);
        } else if (std::exchange(is_after_dle_, false)) {
            if (byte == stx) {
                if (place_ == Place::inside) ++strays_;
                place_ = Place::inside;
                message_.clear();
            } else if (byte == dle && place_ == Place::inside) {
                append(byte, whole);
            } else {
                stray();
            }
        } else if (byte == dle) {
            is_after_dle_ = true;
        } else {
            append(byte, whole);
        }
    }
    return whole;
}

void TslStream::append(char byte, std::vector<std::string>& whole) {
    if (place_ == Place::outside) {
        place_ = Place::bare;
        message_.clear();
        return append_bare(byte, whole);
    }
    if (place_ != Place::inside) return stray();
    message_ += byte;
    constexpr std::size_t count_bytes = 2;
    if (message_.size() < count_bytes) return;
    const std::size_t size = count_bytes + (byte_at(message_, 0) | byte_at(message_, 1) << 8);
    if (size > most_tsl_bytes) {
        stray();
    } else if (message_.size() == size) {
        whole.push_back(std::move(message_));
        place_ = Place::outside;
    }
}

/// Appends a byte of a message without framing. Bytes that cannot be its header are dropped.
void TslStream::append_bare(char byte, std::vector<std::string>& whole) {
    constexpr std::size_t bare_v3_bytes = 18, bare_v3_first = 0x80, reserved_bits = 0xc0,
                          count_bytes = 2;
    constexpr std::size_t version_at = 2, flags_at = 3, most_flags = 3, least_bytes = 6;
    message_ += byte;
    const std::size_t length = message_.size();
    const bool is_v3 = byte_at(message_, 0) >= bare_v3_first;
    std::size_t size = bare_v3_bytes;
    bool is_head = true;
    if (is_v3) {
        is_head = length != 2 || (byte_at(message_, 1) & reserved_bits) == 0;
    } else if (length >= count_bytes) {
        size = count_bytes + (byte_at(message_, 0) | byte_at(message_, 1) << 8);
        is_head = size >= least_bytes && size <= most_tsl_bytes &&
                  (length <= version_at || byte_at(message_, version_at) == 0) &&
                  (length <= flags_at || byte_at(message_, flags_at) <= most_flags);
    }
    if (!is_head) {
        stray();
        is_after_dle_ = byte == dle;
    } else if (length == size) {
        whole.push_back(std::move(message_));
        message_.clear();
        place_ = Place::outside;
    }
}

void TslStream::stray() {
    if (std::exchange(place_, Place::stray) != Place::stray) ++strays_;
}

std::optional<std::vector<TslDisplay>> decode_tsl(std::span<const std::byte> datagram) {
    if (datagram.size() > 1 && datagram[0] == static_cast<std::byte>(dle) &&
        datagram[1] == static_cast<std::byte>(stx))
        if (auto displays = decode_wrapped(datagram)) return displays;
    std::vector<TslDisplay> all;
    bool is_any = false;
    while (!datagram.empty()) {
        if (is_any && std::all_of(datagram.begin(), datagram.end(), is_padding)) break;
        const auto displays = take_message(datagram);
        if (!displays) return std::nullopt;
        is_any = true;
        all.insert(all.end(), displays->begin(), displays->end());
    }
    if (!is_any) return std::nullopt;
    return all;
}

}  // namespace vantage
