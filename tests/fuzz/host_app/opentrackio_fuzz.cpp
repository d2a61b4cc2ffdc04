#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "host_app/control/tracking/opentrackio_sample.h"

namespace {

using namespace vantage;

void check_sample(std::span<const std::byte> bytes, OpentrackioEncoding encoding) {
    const OpentrackioCameraReading reading = read_opentrackio_sample(bytes, encoding);
    if (!reading.camera && reading.fault.empty()) std::abort();
    if (!reading.camera) return;
    const Eigen::Matrix3d turn = reading.camera->world_from_camera.linear();
    if (!((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6)) std::abort();
    if (!reading.camera->world_from_camera.translation().allFinite()) std::abort();
}

}  // namespace

/// Datagrams, each behind its length in two bytes; their checksums are put right, so that the rest
/// is looked at too. Then all of the bytes as a sample.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span all = std::as_bytes(std::span(data, size));
    OpentrackioAssembler assembler;
    constexpr std::size_t checksum_at = 14;
    for (std::span rest = all; rest.size() >= 2;) {
        const std::size_t length = std::min<std::size_t>(
            std::to_integer<std::size_t>(rest[0]) << 8 | std::to_integer<std::size_t>(rest[1]),
            rest.size() - 2);
        std::vector<std::byte> datagram(rest.begin() + 2,
                                        rest.begin() + 2 + static_cast<std::ptrdiff_t>(length));
        rest = rest.subspan(2 + length);
        (void)read_opentrackio_packet(datagram);
        if (datagram.size() < opentrackio_header_bytes) continue;
        const std::uint16_t sum =
            opentrackio_checksum(std::span(datagram).first(checksum_at),
                                 std::span(datagram).subspan(opentrackio_header_bytes));
        datagram[checksum_at] = static_cast<std::byte>(sum >> 8);
        datagram[checksum_at + 1] = static_cast<std::byte>(sum & 0xff);
        const OpentrackioReading reading = read_opentrackio_packet(datagram);
        if (!reading.packet) continue;
        std::string fault;
        const auto sample = assembler.add("peer", *reading.packet, fault);
        if (sample && sample->bytes.size() > most_opentrackio_bytes) std::abort();
        if (sample) check_sample(sample->bytes, sample->encoding);
    }
    const std::span whole = all.first(std::min(all.size(), most_opentrackio_bytes));
    check_sample(whole, OpentrackioEncoding::json);
    check_sample(whole, OpentrackioEncoding::cbor);
    return 0;
}
