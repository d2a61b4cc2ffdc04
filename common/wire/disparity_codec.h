#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/image/image.h"
#include "common/wire/payload_compression.h"

namespace vantage {

/// Lossless disparity: every value is predicted from the one to its left (the first of a row from
/// the one above), the differences are folded to small unsigned numbers (zigzag), their low and
/// high bytes go into planes of their own, and zstd takes the rest. Not thread-safe.
class DisparityEncoder {
  public:
    std::vector<std::byte> encode(const DisparityImage& disparity);

  private:
    PayloadCompressor compressor_;
    std::vector<std::byte> planes_;
};

class DisparityDecoder {
  public:
    /// Throws Error unless the payload is exactly a picture of this size. Precondition: sizes
    /// within 1..max_picture_side_px.
    DisparityImage decode(std::span<const std::byte> payload, int width_px, int height_px);

  private:
    PayloadDecompressor decompressor_;
};

}  // namespace vantage
