#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "common/image/picture_pool.h"
#include "common/wire/codec/chroma.h"
#include "common/wire/codec/payload_compression.h"

namespace vantage {

/// Lossy colour: JPEG of R, G and B; A comes back as 255. At the same bytes 4:4:4 is nearer to what
/// was packed, pixel by pixel, than 4:2:0 at a higher quality, and 4:2:0 nearer to what a programme
/// hands out, whose chroma is halved again (docs/results/takes.md). Not thread-safe.
class JpegEncoder {
  public:
    JpegEncoder();
    ~JpegEncoder();
    JpegEncoder(const JpegEncoder&) = delete;
    JpegEncoder& operator=(const JpegEncoder&) = delete;

    /// quality 1..100.
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

    /// Throws Error unless the payload is one whole colour JPEG of exactly this size; its header is
    /// checked before memory is taken.
    ColourImage decode(std::span<const std::byte> payload, int width_px, int height_px);

    /// Of a payload that was decoded. Throws Error where it is none of those that rigs send.
    Chroma chroma_of(std::span<const std::byte> payload);

  private:
    /// What the library says of a payload that failed. It stays half-way within that picture and
    /// would fail at the next one too: it begins anew.
    std::string trouble();

    void* decompressor_;
    PicturePool pictures_;
};

/// Lossless colour, all four channels: each channel's difference to the pixel above in a plane of
/// its own, then zstd. Not thread-safe.
class LosslessColourEncoder {
  public:
    std::vector<std::byte> encode(const ColourImage& colour);

  private:
    PayloadCompressor compressor_;
    std::vector<std::byte> planes_;
};

class LosslessColourDecoder {
  public:
    /// Throws Error unless the payload is exactly a picture of this size.
    ColourImage decode(std::span<const std::byte> payload, int width_px, int height_px);

  private:
    PayloadDecompressor decompressor_;
    PicturePool pictures_;
};

}  // namespace vantage
