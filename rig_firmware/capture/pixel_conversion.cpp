#include "rig_firmware/capture/pixel_conversion.h"

#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/image/jpeg.h"

namespace vantage {
namespace {

/// Wraps the image's bytes, padding included, without a copy. OpenCV requires writable memory, but
/// nothing writes to it.
cv::Mat rows_of(const RawPicture& picture, int rows, int type, std::size_t stride) {
    return {rows, picture.width_px, type,
            const_cast<void*>(static_cast<const void*>(picture.bytes.data())), stride};
}

ColourImage grey_to_colour(const cv::Mat& grey) {
    ColourImage colour;
    cv::cvtColor(grey, colour, cv::COLOR_GRAY2RGBA);
    return colour;
}

ColourImage deep_grey_to_colour(const cv::Mat& deep, int bits) {
    const int shift = bits - 8;
    GreyImage grey(deep.size());
    for (int y = 0; y < deep.rows; ++y)
        for (int x = 0; x < deep.cols; ++x)
            grey(y, x) = cv::saturate_cast<uchar>(deep.at<std::uint16_t>(y, x) >> shift);
    return grey_to_colour(grey);
}

/// Decodes a JPEG. Deviations from the standard that cost no pixel are accepted; padding after each
/// image is logged once.
ColourImage jpeg_to_colour(const RawPicture& picture) {
    const DecodedJpeg decoded = decode_jpeg(picture.bytes, JpegChannels::rgba);
    if (decoded.image.cols != picture.width_px || decoded.image.rows != picture.height_px)
        fail("a camera picture is a JPEG of {}x{} where the camera promises {}x{}",
             decoded.image.cols, decoded.image.rows, picture.width_px, picture.height_px);
    if (!decoded.oddity.empty())
        log_warning_once("camera JPEG " + decoded.oddity,
                         fmt::format("a camera's JPEG departs from the standard without losing a "
                                     "pixel ({}); it is taken, and so are others like it",
                                     decoded.oddity));
    return decoded.image;
}

std::size_t packed_bytes_per_line(PixelFormat format, int width_px) {
    const auto width = static_cast<std::size_t>(width_px);
    const bool one_byte_a_pixel = format == PixelFormat::grey || format == PixelFormat::nv12;
    return one_byte_a_pixel ? width : 2 * width;
}

/// Smallest size in bytes; the last line may come without its padding.
std::size_t least_bytes(PixelFormat format, int height_px, std::size_t packed, std::size_t stride) {
    const auto height = static_cast<std::size_t>(height_px);
    const std::size_t lines = format == PixelFormat::nv12 ? height + height / 2 : height;
    return stride * (lines - 1) + packed;
}

/// Returns the stride of an uncompressed image. Throws Error if there are too few bytes, or if a
/// side is odd in a format with pairs of pixels.
std::size_t checked_bytes_per_line(const RawPicture& picture) {
    const int width = picture.width_px, height = picture.height_px;
    const std::size_t packed = packed_bytes_per_line(picture.format, width);
    const std::size_t stride = picture.bytes_per_line ? picture.bytes_per_line : packed;
    if (width < 1 || height < 1 || stride < packed ||
        picture.bytes.size() < least_bytes(picture.format, height, packed, stride))
        fail("a camera picture of {}x{} in {} came with {} bytes in lines of {}, too few", width,
             height, fourcc_text(fourcc_of(picture.format)), picture.bytes.size(), stride);
    const bool pairs_of_pixels =
        picture.format == PixelFormat::yuyv || picture.format == PixelFormat::nv12;
    if (pairs_of_pixels &&
        (width % 2 != 0 || (picture.format == PixelFormat::nv12 && height % 2 != 0)))
        fail("a camera picture of {}x{} in {} must have even sides", width, height,
             fourcc_text(fourcc_of(picture.format)));
    return stride;
}

}  // namespace

std::vector<PicturePlane> planes_of(const RawPicture& picture) {
    const int width = picture.width_px, height = picture.height_px;
    if (picture.format == PixelFormat::mjpg) fail("a compressed picture has no planes");
    const std::size_t stride = checked_bytes_per_line(picture);
    switch (picture.format) {
        case PixelFormat::yuyv:
            return {{TextureFormat::rgba8, width / 2, height, 0, stride}};
        case PixelFormat::nv12:
            return {{TextureFormat::r8, width, height, 0, stride},
                    {TextureFormat::rg8, width / 2, height / 2,
                     stride * static_cast<std::size_t>(height), stride}};
        case PixelFormat::y10:
        case PixelFormat::y16:
            return {{TextureFormat::rg8, width, height, 0, stride}};
        case PixelFormat::grey:
        case PixelFormat::mjpg:
            break;
    }
    return {{TextureFormat::r8, width, height, 0, stride}};
}

ColourImage to_colour(const RawPicture& picture) {
    const int height = picture.height_px;
    if (picture.format == PixelFormat::mjpg) return jpeg_to_colour(picture);
    const std::size_t stride = checked_bytes_per_line(picture);
    ColourImage colour;
    switch (picture.format) {
        case PixelFormat::yuyv:
            cv::cvtColor(rows_of(picture, height, CV_8UC2, stride), colour,
                         cv::COLOR_YUV2RGBA_YUYV);
            return colour;
        case PixelFormat::nv12:
            cv::cvtColor(rows_of(picture, height * 3 / 2, CV_8UC1, stride), colour,
                         cv::COLOR_YUV2RGBA_NV12);
            return colour;
        case PixelFormat::grey:
            return grey_to_colour(rows_of(picture, height, CV_8UC1, stride));
        case PixelFormat::y10:
            return deep_grey_to_colour(rows_of(picture, height, CV_16UC1, stride), 10);
        case PixelFormat::y16:
            return deep_grey_to_colour(rows_of(picture, height, CV_16UC1, stride), 16);
        case PixelFormat::mjpg:
            break;
    }
    return colour;
}

}  // namespace vantage
