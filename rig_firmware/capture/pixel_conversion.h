#pragma once

#include <cstddef>
#include <span>

#include "common/image/image.h"
#include "rig_firmware/capture/pixel_format.h"

namespace vantage {

/// One picture as a driver delivers it.
struct RawPicture {
    PixelFormat format = PixelFormat::grey;
    int width_px = 0, height_px = 0;
    std::size_t bytes_per_line = 0;  ///< of the first plane, padding included; 0: no padding
    std::span<const std::byte> bytes;
};

/// Converts to RGBA: YUV as BT.601 of limited range, as UVC cameras send it; grey to equal
/// channels; deep grey to its upper 8 bits. Throws Error if the bytes are fewer than the size
/// needs, or are no whole JPEG of that size.
ColourImage to_colour(const RawPicture& picture);

}  // namespace vantage
