#include "rig_firmware/capture/pixel_format.h"

#include <linux/videodev2.h>

#include "common/base/error.h"

namespace vantage {

const std::vector<PixelFormat>& known_pixel_formats() {
    static const std::vector<PixelFormat> formats = {PixelFormat::yuyv, PixelFormat::nv12,
                                                     PixelFormat::grey, PixelFormat::y10,
                                                     PixelFormat::y16,  PixelFormat::mjpg};
    return formats;
}

std::string fourcc_text(std::uint32_t fourcc) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += static_cast<char>((fourcc >> (8 * i)) & 0x7f);
    constexpr std::uint32_t big_endian = 1u << 31;
    return (fourcc & big_endian) != 0 ? text + "-BE" : text;
}

std::uint32_t fourcc_of(PixelFormat format) {
    switch (format) {
        case PixelFormat::yuyv:
            return V4L2_PIX_FMT_YUYV;
        case PixelFormat::nv12:
            return V4L2_PIX_FMT_NV12;
        case PixelFormat::grey:
            return V4L2_PIX_FMT_GREY;
        case PixelFormat::y10:
            return V4L2_PIX_FMT_Y10;
        case PixelFormat::y16:
            return V4L2_PIX_FMT_Y16;
        case PixelFormat::mjpg:
            return V4L2_PIX_FMT_MJPEG;
    }
    return 0;
}

PixelFormat parse_pixel_format(const std::string& fourcc) {
    std::string known;
    for (const PixelFormat format : known_pixel_formats()) {
        const std::string text = fourcc_text(fourcc_of(format));
        if (text == fourcc) return format;
        known += fmt::format("{}'{}'", known.empty() ? "" : ", ", text);
    }
    fail("the pixel format '{}' is not one that is understood; the ones there are: {}", fourcc,
         known);
}

}  // namespace vantage
