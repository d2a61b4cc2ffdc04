#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace vantage {

/// A decoded JPEG of a camera or a file, with everything that was odd about it.
struct DecodedJpeg {
    cv::Mat image;  ///< 8 bits a channel, as it is stored: the orientation is not applied
    /// The library's first warning of a departure from the standard that costs no pixel, such as
    /// bytes before a marker; empty for a clean file.
    std::string oddity;
    /// How viewers turn the picture, by its EXIF data: 1 to 8, 1 for as it is stored.
    int orientation = 1;
};

enum class JpegChannels {
    as_stored,  ///< one channel of grey, or R, G, B
    rgba,       ///< R, G, B, A with A = 255, of grey pictures too
};

/// Decodes a JPEG with libjpeg-turbo. Warnings of the library that lose no pixel become `oddity`;
/// missing or damaged pixels are an Error, and so is a picture in CMYK. The header is checked
/// before memory is taken. `common/wire` has the strict decoder of Vantage's own stream.
DecodedJpeg decode_jpeg(std::span<const std::byte> bytes,
                        JpegChannels channels = JpegChannels::as_stored);

/// Encodes one channel of grey or R, G, B, 8 bits each, at quality 95 with halved chroma. Throws
/// Error for other pictures.
std::vector<std::byte> encode_jpeg(const cv::Mat& image);

}  // namespace vantage
