#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

namespace vantage {

struct DecodedPng {
    cv::Mat image;        ///< 8 or 16 bits, one channel of grey or R, G, B
    int orientation = 1;  ///< by its EXIF data (chunk eXIf), as DecodedJpeg's
};

/// A PNG by libspng: fewer bits of grey are spread to eight, palettes are looked up, alpha is left
/// out. Throws Error with what is wrong with it; its header is checked before memory is taken.
DecodedPng decode_png(std::span<const std::byte> bytes);

/// Encodes one channel of 8 or 16 bits, or R, G, B or R, G, B, A of 8 bits. Throws Error for
/// others.
std::vector<std::byte> encode_png(const cv::Mat& image);

}  // namespace vantage
