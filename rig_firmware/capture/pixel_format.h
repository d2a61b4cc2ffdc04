#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vantage {

/// Supported pixel formats of cameras, in order of preference: colour before grey, uncompressed
/// before compressed.
enum class PixelFormat {
    yuyv,  ///< 4:2:2, Y0 U Y1 V
    nv12,  ///< 4:2:0, a plane of Y and one of interleaved U and V
    grey,  ///< 8 bits
    y10,   ///< 10 bits in 16, little-endian, high bits 0
    y16,   ///< 16 bits, little-endian
    mjpg,  ///< one JPEG per frame
};
const std::vector<PixelFormat>& known_pixel_formats();

/// Text of a kernel format code with four characters, blanks included: "YUYV", "Y10 "; with the
/// suffix "-BE" if the code is big-endian.
std::string fourcc_text(std::uint32_t fourcc);
std::uint32_t fourcc_of(PixelFormat format);
/// Throws Error that lists the known formats.
PixelFormat parse_pixel_format(const std::string& fourcc);

}  // namespace vantage
