#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/wire/codec/chroma.h"
#include "common/wire/frame_message.h"

namespace vantage {

/// A frame in its wire form: the three message parts that follow a RigMessage.
struct PackedFrame {
    std::uint64_t trigger_index = 0;
    bool is_raw_pair = false;
    std::vector<std::byte> header;     ///< FrameHeader of frame.proto
    std::vector<std::byte> colour;     ///< JPEG or lossless; empty: no colour. A JPEG may be
                                       ///< followed by that of the right image
    std::vector<std::byte> disparity;  ///< lossless; empty: no disparity. In a raw pair: the right
                                       ///< image

    std::size_t bytes() const { return header.size() + colour.size() + disparity.size(); }
};

/// Packs a view's colour early, on another thread than its FrameEncoder. Not thread-safe.
class ColourPacker {
  public:
    /// With the settings of the FrameEncoder that packs the rest.
    explicit ColourPacker(int jpeg_quality, Chroma chroma = Chroma::quarter);
    ~ColourPacker();

    /// Sets frame.packed_colour and frame.times.pack_ms. Precondition: the frame has colour.
    void pack(RigFrame& frame);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Encodes a RigFrame to message parts. Keeps its codecs between frames. Not thread-safe.
class FrameEncoder {
  public:
    /// `jpeg_quality` is 1..100, or 0 for lossless colour. Raw pairs are always lossless.
    explicit FrameEncoder(int jpeg_quality, Chroma chroma = Chroma::quarter);
    ~FrameEncoder();

    /// Uses packed_colour if present. Fills in frame.times.pack_ms and frame.published. Throws
    /// Error naming the first invalid value: decoders accept everything that it returns.
    PackedFrame encode(RigFrame& frame);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The content of a frame's header, before its images are decoded.
struct FrameHead {
    enum class Colour { none, jpeg, lossless };
    RigFrame frame;  ///< without its images; geometry has the colour's size
    Colour colour = Colour::none;
    std::size_t right_jpeg_bytes = 0;  ///< at the end of the colour payload
    cv::Size disparity_px;             ///< 0x0: no disparity
};
/// Throws Error like FrameDecoder::decode.
FrameHead decode_frame_head(std::span<const std::byte> header);

/// The images in a colour payload.
struct ColourParts {
    std::span<const std::byte> left, right;  ///< right: a JPEG; empty: none
};
/// Throws Error if the payload is shorter than the head states.
ColourParts colour_parts(const FrameHead& head, std::span<const std::byte> colour);

/// A copy of the bytes; null if there are none.
SharedBytes shared(std::span<const std::byte> bytes);

/// Decodes message parts to a RigFrame. Keeps its codecs between frames. Not thread-safe.
class FrameDecoder {
  public:
    FrameDecoder();
    ~FrameDecoder();

    /// Decodes untrusted parts. Throws Error with one sentence if they are truncated, oversized, of
    /// another schema version, contradictory in size, not finite, or without a rigid pose. Checks
    /// all this before it allocates memory for images.
    RigFrame decode(std::span<const std::byte> header, std::span<const std::byte> colour,
                    std::span<const std::byte> disparity);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
