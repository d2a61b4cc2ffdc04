#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vantage {

/// The forms of camera pictures that Vantage takes, in the order in which it prefers them: colour
/// before grey, whole pixels before compressed ones.
enum class PixelFormat {
    yuyv,  ///< 4:2:2, Y0 U Y1 V
    nv12,  ///< 4:2:0, a plane of Y and one of U and V in turn
    grey,  ///< 8 bits
    y10,   ///< 10 bits in 16, little-endian, high bits 0
    y16,   ///< 16 bits, little-endian
    mjpg,  ///< a JPEG a picture
};
const std::vector<PixelFormat>& known_pixel_formats();

/// The kernel's code of four characters, blanks included: "YUYV", "Y10 "; "-BE" after it where the
/// code says big-endian.
std::string fourcc_text(std::uint32_t fourcc);
std::uint32_t fourcc_of(PixelFormat format);
/// Throws Error that lists the known ones.
PixelFormat parse_pixel_format(const std::string& fourcc);

}  // namespace vantage
