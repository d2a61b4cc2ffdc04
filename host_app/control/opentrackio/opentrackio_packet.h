#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vantage {

// The UDP transport of OpenTrackIO (SMPTE RIS OSVP, https://www.opentrackio.org): a sample in one
// or more packets, each a header of 16 bytes, most significant byte first, and a segment of the
// sample.

enum class OpentrackioEncoding : std::uint8_t { json = 1, cbor = 2 };

constexpr std::size_t opentrackio_header_bytes = 16;
/// Largest sample that is accepted. The largest samples of the standard have 2 kB.
constexpr std::size_t most_opentrackio_bytes = 8192;
/// Largest segment that is sent: an Ethernet frame without the headers of IPv6 and UDP.
constexpr std::size_t opentrackio_segment_bytes = 1500 - 40 - 8 - opentrackio_header_bytes;

/// Fletcher's checksum of 16 bits over the header without its checksum, and the segment.
std::uint16_t opentrackio_checksum(std::span<const std::byte> header,
                                   std::span<const std::byte> segment);

/// The packets of a sample. `sequence` is that of all of them.
std::vector<std::vector<std::byte>> opentrackio_packets(
    std::span<const std::byte> sample, OpentrackioEncoding encoding, std::uint16_t sequence,
    std::size_t segment_bytes = opentrackio_segment_bytes);

/// One packet of a sample.
struct OpentrackioPacket {
    OpentrackioEncoding encoding = OpentrackioEncoding::json;
    std::uint16_t sequence = 0;
    std::uint32_t offset = 0;
    bool is_last = false;
    std::span<const std::byte> segment;
};
/// A packet, or a sentence about what is wrong with the datagram.
struct OpentrackioReading {
    std::optional<OpentrackioPacket> packet;
    std::string fault;
};
/// Reads the header of a datagram and checks its checksum.
OpentrackioReading read_opentrackio_packet(std::span<const std::byte> datagram);

/// Joins the segments of samples, in any order. It holds one incomplete sample per sender and at
/// most 8 senders. Not thread-safe.
class OpentrackioAssembler {
  public:
    struct Sample {
        OpentrackioEncoding encoding = OpentrackioEncoding::json;
        std::vector<std::byte> bytes;
    };
    /// Adds a packet. Returns the sample that it completes. A segment that does not fit starts the
    /// sample anew and is told in `fault`; so is a sample that is given up for a newer one.
    std::optional<Sample> add(const std::string& sender, const OpentrackioPacket& packet,
                              std::string& fault);

  private:
    struct Incomplete {
        std::uint16_t sequence = 0;
        OpentrackioEncoding encoding = OpentrackioEncoding::json;
        std::map<std::uint32_t, std::vector<std::byte>> segments;
        std::size_t bytes = 0;
        std::optional<std::size_t> size;  ///< known once the last segment has come
    };
    std::map<std::string, Incomplete> incomplete_;
};

}  // namespace vantage
