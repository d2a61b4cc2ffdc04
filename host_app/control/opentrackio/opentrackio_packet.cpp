#include "host_app/control/opentrackio/opentrackio_packet.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace vantage {
namespace {

constexpr std::string_view identifier = "OTrk";
constexpr std::size_t encoding_at = 5, sequence_at = 6, offset_at = 8, length_at = 12,
                      checksum_at = 14;
constexpr std::uint16_t last_flag = 0x8000;
constexpr std::size_t most_senders = 8;

void put_number(std::byte* at, std::size_t bytes, std::uint32_t value) {
    for (std::size_t i = 0; i < bytes; ++i)
        at[i] = static_cast<std::byte>(value >> (8 * (bytes - 1 - i)) & 0xff);
}

std::uint32_t number_at(const std::byte* at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
        value = value << 8 | std::to_integer<std::uint32_t>(at[i]);
    return value;
}

}  // namespace

std::uint16_t opentrackio_checksum(std::span<const std::byte> header,
                                   std::span<const std::byte> segment) {
    unsigned first = 0, second = 0;
    for (const std::span<const std::byte> part : {header, segment})
        for (const std::byte byte : part) {
            first = (first + std::to_integer<unsigned>(byte)) & 0xff;
            second = (second + first) & 0xff;
        }
    return static_cast<std::uint16_t>(second << 8 | first);
}

std::vector<std::vector<std::byte>> opentrackio_packets(std::span<const std::byte> sample,
                                                        OpentrackioEncoding encoding,
                                                        std::uint16_t sequence,
                                                        std::size_t segment_bytes) {
    std::vector<std::vector<std::byte>> packets;
    for (std::size_t at = 0; at < sample.size(); at += segment_bytes) {
        const std::size_t size = std::min(segment_bytes, sample.size() - at);
        std::vector<std::byte> packet(opentrackio_header_bytes);
        std::ranges::transform(identifier, packet.begin(),
                               [](char c) { return static_cast<std::byte>(c); });
        packet[encoding_at] = static_cast<std::byte>(encoding);
        put_number(&packet[sequence_at], 2, sequence);
        put_number(&packet[offset_at], 4, static_cast<std::uint32_t>(at));
        const bool is_last = at + size == sample.size();
        put_number(&packet[length_at], 2,
                   static_cast<std::uint32_t>(size) | (is_last ? last_flag : 0u));
        const std::span segment = sample.subspan(at, size);
        put_number(&packet[checksum_at], 2,
                   opentrackio_checksum(std::span(packet).first(checksum_at), segment));
        packet.insert(packet.end(), segment.begin(), segment.end());
        packets.push_back(std::move(packet));
    }
    return packets;
}

OpentrackioReading read_opentrackio_packet(std::span<const std::byte> datagram) {
    if (datagram.size() < opentrackio_header_bytes)
        return {{},
                fmt::format("{} bytes, where the header of OpenTrackIO alone has {}",
                            datagram.size(), opentrackio_header_bytes)};
    if (!std::equal(identifier.begin(), identifier.end(), datagram.begin(),
                    [](char c, std::byte byte) { return static_cast<std::byte>(c) == byte; }))
        return {{}, "a datagram that does not begin with OTrk, as those of OpenTrackIO do"};
    const std::uint32_t length = number_at(&datagram[length_at], 2);
    const std::span segment = datagram.subspan(opentrackio_header_bytes);
    if ((length & ~std::uint32_t{last_flag}) != segment.size())
        return {{},
                fmt::format("an OpenTrackIO packet with {} bytes behind its header, which says {}",
                            segment.size(), length & ~std::uint32_t{last_flag})};
    const std::uint32_t told = number_at(&datagram[checksum_at], 2);
    if (const std::uint16_t sum = opentrackio_checksum(datagram.first(checksum_at), segment);
        sum != told)
        return {{},
                fmt::format("an OpenTrackIO packet with the checksum 0x{:04x}, where its bytes "
                            "give 0x{:04x}",
                            told, sum)};
    const auto encoding = std::to_integer<unsigned>(datagram[encoding_at]);
    if (encoding != 1 && encoding != 2)
        return {{},
                fmt::format("an OpenTrackIO packet with the encoding {}; Vantage reads 1 (JSON) "
                            "and 2 (CBOR)",
                            encoding)};
    const std::uint32_t offset = number_at(&datagram[offset_at], 4);
    if (segment.empty() || offset + segment.size() > most_opentrackio_bytes)
        return {{},
                fmt::format("an OpenTrackIO sample of {} bytes; Vantage reads 1 to {}",
                            offset + segment.size(), most_opentrackio_bytes)};
    return {OpentrackioPacket{static_cast<OpentrackioEncoding>(encoding),
                              static_cast<std::uint16_t>(number_at(&datagram[sequence_at], 2)),
                              offset, (length & last_flag) != 0, segment},
            {}};
}

std::optional<OpentrackioAssembler::Sample> OpentrackioAssembler::add(
    const std::string& sender, const OpentrackioPacket& packet, std::string& fault) {
    const std::vector<std::byte> segment(packet.segment.begin(), packet.segment.end());
    if (packet.offset == 0 && packet.is_last) {
        incomplete_.erase(sender);
        return Sample{packet.encoding, segment};
    }
    if (!incomplete_.contains(sender) && incomplete_.size() >= most_senders)
        incomplete_.erase(incomplete_.begin());
    Incomplete& sample = incomplete_[sender];
    const bool is_other = packet.sequence != sample.sequence || packet.encoding != sample.encoding;
    if (is_other && !sample.segments.empty()) {
        fault = fmt::format("an OpenTrackIO sample of which {} bytes came, and the rest did not",
                            sample.bytes);
        sample = {};
    }
    sample.sequence = packet.sequence;
    sample.encoding = packet.encoding;
    if (packet.is_last) sample.size = packet.offset + segment.size();
    if (sample.segments.emplace(packet.offset, segment).second) sample.bytes += segment.size();
    if (!sample.size || sample.bytes < *sample.size) return std::nullopt;
    Sample whole{sample.encoding, {}};
    for (const auto& [offset, bytes] : sample.segments) {
        if (offset != whole.bytes.size()) break;
        whole.bytes.insert(whole.bytes.end(), bytes.begin(), bytes.end());
    }
    const bool fits = whole.bytes.size() == *sample.size && whole.bytes.size() == sample.bytes;
    incomplete_.erase(sender);
    if (fits) return whole;
    fault = "an OpenTrackIO sample whose segments do not fit together";
    return std::nullopt;
}

}  // namespace vantage
