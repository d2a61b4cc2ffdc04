#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

namespace vantage {

/// A JPEG by libjpeg-turbo: 8 bits, one channel of grey or R, G, B, as it is stored: no note in the
/// file turns it. Throws Error with what is wrong with it; its header is checked before memory is
/// taken. `common/wire` has the one for frames, which keeps its state.
cv::Mat decode_jpeg(std::span<const std::byte> bytes);

/// Of one channel or R, G, B, of 8 bits, at a quality that looks like the picture; chroma is
/// halved. Throws Error for others.
std::vector<std::byte> encode_jpeg(const cv::Mat& image);

}  // namespace vantage
