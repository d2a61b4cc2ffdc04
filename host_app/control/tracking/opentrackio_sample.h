#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"
#include "host_app/flight/camera_state.h"
#include "host_app/ltc/smpte_code.h"

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

/// The part of an OpenTrackIO sample that flies a camera. OpenTrackIO's stage has z up and looks
/// along y: its x is the world's x, its y is -z, and its z is y.
struct OpentrackioCamera {
    std::optional<std::uint32_t> source;  ///< sourceNumber
    Pose world_from_camera = Pose::Identity();
    std::optional<double> focal_length_mm;
    std::optional<double> sensor_width_mm;
    std::optional<double> focus_m;
};
/// A camera, or a sentence about what is wrong with the sample.
struct OpentrackioCameraReading {
    std::optional<OpentrackioCamera> camera;
    std::string fault;
};
OpentrackioCameraReading read_opentrackio_sample(std::span<const std::byte> bytes,
                                                 OpentrackioEncoding encoding);

/// A sample of the virtual camera.
struct OpentrackioSample {
    CameraState camera;
    std::uint32_t source = 1;
    std::string source_id, sample_id;  ///< of the form urn:uuid:...
    int width_px = 0, height_px = 0;
    double sensor_width_mm = 36;
    PulseGrid::Fraction rate{};  ///< of the programme
    TaiTime time{};
    std::uint32_t sequence = 0;
    std::optional<SmpteCode> timecode;
    std::optional<bool> ptp_locked;  ///< empty: unknown
};
/// Writes all that Vantage knows, including the static part, so that receivers may join at any
/// time. Version 1.0.1 of the protocol.
std::vector<std::byte> write_opentrackio_sample(const OpentrackioSample& sample,
                                                OpentrackioEncoding encoding);

/// A UUID (RFC 9562, version 8) as a URN: `base` with `number` as its last 48 bits.
std::string uuid_urn(std::uint64_t base, std::uint64_t number);

}  // namespace vantage
