#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

namespace vantage {

/// A PNG by libspng: 8 or 16 bits, one channel of grey or R, G, B; fewer bits of grey are spread to
/// eight, palettes are looked up, alpha is left out. Throws Error with what is wrong with it; its
/// header is checked before memory is taken.
cv::Mat decode_png(std::span<const std::byte> bytes);

/// Of one channel of 8 or 16 bits, or of R, G, B of 8 bits. Throws Error for others.
std::vector<std::byte> encode_png(const cv::Mat& image);

}  // namespace vantage
