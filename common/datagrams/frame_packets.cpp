#include "common/datagrams/frame_packets.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <sodium.h>

#include "common/base/error.h"

namespace vantage {
namespace {

/// Stands before the bytes of each packet, little-endian.
struct PacketHead {
    std::uint32_t number = 0, packet = 0, packets = 0;
};
/// Of a number in a packet's head and before a part.
constexpr std::size_t number_bytes = sizeof(std::uint32_t);
constexpr std::size_t head_bytes = 3 * number_bytes;
constexpr std::size_t content_bytes = packet_bytes - head_bytes;
constexpr std::size_t seal_bytes = crypto_generichash_BYTES;

void put(std::byte* to, std::uint32_t value) {
    for (std::size_t i = 0; i < sizeof value; ++i) to[i] = static_cast<std::byte>(value >> (8 * i));
}

std::uint32_t get(const std::byte* from) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i)
        value |= std::to_integer<std::uint32_t>(from[i]) << (8 * i);
    return value;
}

std::array<std::byte, seal_bytes> seal_of(std::span<const std::byte> content,
                                          std::string_view passphrase) {
    const std::size_t key_bytes =
        std::min<std::size_t>(passphrase.size(), crypto_generichash_KEYBYTES_MAX);
    std::array<std::byte, seal_bytes> seal;
    crypto_generichash(reinterpret_cast<unsigned char*>(seal.data()), seal.size(),
                       reinterpret_cast<const unsigned char*>(content.data()), content.size(),
                       reinterpret_cast<const unsigned char*>(passphrase.data()), key_bytes);
    return seal;
}

}  // namespace

std::size_t message_bytes_of(std::size_t bytes_of_parts) {
    return frame_message_parts * number_bytes + bytes_of_parts + seal_bytes;
}

std::size_t packets_of(std::size_t message_bytes) {
    return (message_bytes + content_bytes - 1) / content_bytes;
}

std::vector<std::byte> join_parts(const FrameParts& parts, std::string_view passphrase) {
    std::size_t bytes_of_parts = 0;
    for (const auto& part : parts) bytes_of_parts += part.size();
    std::vector<std::byte> message;
    message.reserve(message_bytes_of(bytes_of_parts));
    for (const auto& part : parts) {
        std::array<std::byte, number_bytes> size;
        put(size.data(), static_cast<std::uint32_t>(part.size()));
        message.insert(message.end(), size.begin(), size.end());
        message.insert(message.end(), part.begin(), part.end());
    }
    const auto seal = seal_of(message, passphrase);
    message.insert(message.end(), seal.begin(), seal.end());
    return message;
}

FrameParts split_message(std::span<const std::byte> message, std::string_view passphrase) {
    if (message.size() < seal_bytes)
        fail("a frame of {} bytes came as datagrams, which is less than its seal", message.size());
    std::span<const std::byte> rest = message.first(message.size() - seal_bytes);
    const auto seal = seal_of(rest, passphrase);
    if (sodium_memcmp(seal.data(), message.data() + rest.size(), seal.size()) != 0)
        fail("a frame came as datagrams whose seal is not this rig's");
    FrameParts parts;
    for (auto& part : parts) {
        const std::size_t size = rest.size() < number_bytes ? 0 : get(rest.data());
        if (rest.size() < number_bytes || rest.size() - number_bytes < size)
            fail("a frame came as datagrams with parts beyond its {} bytes", message.size());
        part = rest.subspan(number_bytes, size);
        rest = rest.subspan(number_bytes + size);
    }
    if (!rest.empty())
        fail("a frame came as datagrams with {} bytes behind its parts", rest.size());
    return parts;
}

bool cut_message(std::span<const std::byte> message, std::uint32_t number,
                 const std::function<bool(std::span<const std::byte>)>& send) {
    const auto packets = static_cast<std::uint32_t>(packets_of(message.size()));
    std::array<std::byte, packet_bytes> packet;
    put(packet.data(), number);
    put(packet.data() + 2 * number_bytes, packets);
    for (std::uint32_t i = 0; i < packets; ++i) {
        const std::span<const std::byte> content = message.subspan(
            i * content_bytes, std::min(content_bytes, message.size() - i * content_bytes));
        put(packet.data() + number_bytes, i);
        std::copy(content.begin(), content.end(), packet.begin() + head_bytes);
        if (!send(std::span(packet).first(head_bytes + content.size()))) return false;
    }
    return true;
}

std::optional<std::vector<std::byte>> FrameJoiner::take(std::span<const std::byte> packet) {
    static const std::size_t most_packets = packets_of(max_datagram_message_bytes);
    if (packet.size() <= head_bytes || packet.size() > packet_bytes)
        fail("a datagram of {} bytes came, which is not part of a frame", packet.size());
    const PacketHead head{get(packet.data()), get(packet.data() + number_bytes),
                          get(packet.data() + 2 * number_bytes)};
    if (head.packet == 0) {
        number_ = head.number;
        packets_ = head.packets;
        message_.clear();
        next_ = 0;
    }
    const bool is_last = head.packet + 1 == head.packets;
    const bool is_next = head.number == number_ && head.packet == next_ &&
                         head.packets == packets_ && head.packet < head.packets;
    const bool is_full = packet.size() == packet_bytes;
    if (!is_next || (!is_full && !is_last) || head.packets > most_packets) {
        next_ = packets_ = 0;
        fail("a datagram {} of {} of frame {} came, which does not follow the one before it",
             head.packet, head.packets, head.number);
    }
    const std::span<const std::byte> content = packet.subspan(head_bytes);
    message_.insert(message_.end(), content.begin(), content.end());
    ++next_;
    if (!is_last) return std::nullopt;
    next_ = packets_ = 0;
    return std::exchange(message_, {});
}

}  // namespace vantage
