#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "common/image/picture_pool.h"
#include "common/wire/codec/chroma.h"
#include "common/wire/codec/payload_compression.h"

namespace vantage {

/// Lossy colour: a JPEG of R, G and B; A decodes as 255. At equal size, 4:4:4 has smaller errors
/// per pixel than 4:2:0 at a higher quality, and 4:2:0 smaller errors after a programme's own
/// chroma subsampling (docs/results/takes.md). Not thread-safe.
class JpegEncoder {
  public:
    JpegEncoder();
    ~JpegEncoder();
    JpegEncoder(const JpegEncoder&) = delete;
    JpegEncoder& operator=(const JpegEncoder&) = delete;

    /// `quality` is 1..100.
    std::vector<std::byte> encode(const ColourImage& colour, int quality, Chroma chroma);

  private:
    void* compressor_;
};

class JpegDecoder {
  public:
    JpegDecoder();
    ~JpegDecoder();
    JpegDecoder(const JpegDecoder&) = delete;
    JpegDecoder& operator=(const JpegDecoder&) = delete;

    /// Throws Error unless the payload is one complete colour JPEG of exactly this size. Checks the
    /// header before it allocates memory. Decodes into `memory`, an image of this size, unless it
    /// is empty.
    ColourImage decode(std::span<const std::byte> payload, int width_px, int height_px,
                       ColourImage memory = {});

    /// The chroma subsampling of a valid payload. Throws Error if it is not one that rigs send.
    Chroma chroma_of(std::span<const std::byte> payload);

  private:
    /// The library's reason for a failure. Recreates the decoder, which would otherwise fail for
    /// the next image, too.
    std::string trouble();

    void* decompressor_;
    PicturePool pictures_;
};

/// Lossless colour with four channels: the difference of each channel to the pixel above, as
/// separate planes, compressed by zstd. Not thread-safe.
class LosslessColourEncoder {
  public:
    std::vector<std::byte> encode(const ColourImage& colour);

  private:
    PayloadCompressor compressor_;
    std::vector<std::byte> planes_;
};

class LosslessColourDecoder {
  public:
    /// Throws Error unless the payload is exactly one image of this size.
    ColourImage decode(std::span<const std::byte> payload, int width_px, int height_px);

  private:
    PayloadDecompressor decompressor_;
    PicturePool pictures_;
};

}  // namespace vantage
