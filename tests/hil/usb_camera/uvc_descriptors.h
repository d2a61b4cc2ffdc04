#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vantage::usb {

using Bytes = std::vector<std::uint8_t>;

void put(Bytes& bytes, int count, std::uint32_t value);  ///< little-endian
void append(Bytes& bytes, const Bytes& more);

struct CameraMode {
    int width_px = 0, height_px = 0, rate_hz = 0;
    std::uint32_t frame_bytes() const {
        return 2u * static_cast<std::uint32_t>(width_px) * static_cast<std::uint32_t>(height_px);
    }
};

inline constexpr std::uint16_t vendor_id = 0x1209, product_id = 0xca01;
inline constexpr std::uint8_t stream_endpoint = 0x81;
inline constexpr std::uint16_t packet_bytes = 512;
/// Of the header that goes before every frame.
inline constexpr std::uint32_t payload_header_bytes = 2;

// Descriptors of a USB Video Class 1.0 camera with one YUY2 mode over a bulk endpoint.
Bytes device_descriptor();
Bytes configuration_descriptor(const CameraMode& mode);
Bytes string_descriptor(int index, const std::string& serial);
/// The video probe and commit control: what the camera is about to send.
Bytes probe_control(const CameraMode& mode);

}  // namespace vantage::usb
