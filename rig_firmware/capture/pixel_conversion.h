#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/gl/objects/texture.h"
#include "common/image/image.h"
#include "rig_firmware/capture/pixel_format.h"

namespace vantage {

/// Image in the form that a driver delivers it.
struct RawPicture {
    PixelFormat format = PixelFormat::grey;
    int width_px = 0, height_px = 0;
    std::size_t bytes_per_line = 0;  ///< of the first plane, with padding; 0: no padding
    std::span<const std::byte> bytes;
};

/// One plane of an image as texels, for conversion on a GPU.
struct PicturePlane {
    TextureFormat format = TextureFormat::r8;
    int width_px = 0, height_px = 0;  ///< in texels: YUYV has half as many texels as pixels
    std::size_t offset = 0, bytes_per_line = 0;
};

/// Splits an image into planes. GREY: r8. Y10, Y16: rg8, low byte first. YUYV: rgba8, two pixels
/// per texel. NV12: r8, then rg8 of half the size. Throws Error for a JPEG, which has no planes,
/// and like to_colour().
std::vector<PicturePlane> planes_of(const RawPicture& picture);

/// Converts to RGBA: YUV as BT.601 of limited range, as UVC cameras send it; grey to equal
/// channels; deep grey to its upper 8 bits. Throws Error if there are fewer bytes than the size
/// needs, or no complete JPEG of that size.
ColourImage to_colour(const RawPicture& picture);

}  // namespace vantage
