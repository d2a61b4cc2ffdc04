#pragma once

#include <cstddef>
#include <span>

#include <opencv2/core.hpp>

namespace vantage {

/// A binary PGM or PPM (P5, P6), as data sets and raw developers have them: 8 or 16 bits,
/// all of them used, one channel of grey or R, G, B. Throws Error with what is wrong
/// with it; its header is checked before memory is taken.
cv::Mat decode_netpbm(std::span<const std::byte> bytes);

}  // namespace vantage
