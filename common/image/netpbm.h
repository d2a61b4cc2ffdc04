#pragma once

#include <cstddef>
#include <span>

#include <opencv2/core.hpp>

#include "common/image/code_range.h"

namespace vantage {

/// A picture of the Netpbm family: one channel of grey or R, G, B. Codes of up to 255 are 8 bits
/// wide, others 16.
struct NetpbmPicture {
    cv::Mat image;
    int largest_code = 0;  ///< that the header allows
};

/// Decodes PBM, PGM and PPM, plain (P1, P2, P3) and of bytes (P4, P5, P6). Of a PBM black is 0 and
/// white 255. Throws Error with what is wrong with it; the header is checked before memory is
/// taken.
NetpbmPicture decode_netpbm(std::span<const std::byte> bytes);

}  // namespace vantage
