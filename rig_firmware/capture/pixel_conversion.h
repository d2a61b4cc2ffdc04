#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/gl/objects/texture.h"
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

/// A plane of a picture as texels, for a GPU that is to convert it.
struct PicturePlane {
    TextureFormat format = TextureFormat::r8;
    int width_px = 0, height_px = 0;  ///< in texels: YUYV has half as many as pixels
    std::size_t offset = 0, bytes_per_line = 0;
};

/// GREY: r8. Y10, Y16: rg8, low byte first. YUYV: rgba8, two pixels a texel. NV12: r8, then rg8 of
/// half the size. Throws Error for a JPEG, which has no planes, and as to_colour does.
std::vector<PicturePlane> planes_of(const RawPicture& picture);

/// Converts to RGBA: YUV as BT.601 of limited range, as UVC cameras send it; grey to equal
/// channels; deep grey to its upper 8 bits. Throws Error if the bytes are fewer than the size
/// needs, or are no whole JPEG of that size.
ColourImage to_colour(const RawPicture& picture);

}  // namespace vantage
