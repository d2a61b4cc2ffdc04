#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/wire/codec/chroma.h"
#include "common/wire/frame_message.h"

namespace vantage {

/// A frame as it travels: the three parts that follow the RigMessage of its delivery.
struct PackedFrame {
    std::uint64_t trigger_index = 0;
    bool is_raw_pair = false;
    std::vector<std::byte> header;     ///< FrameHeader of frame.proto
    std::vector<std::byte> colour;     ///< JPEG or lossless; empty where the frame has no colour.
                                       ///< Behind a JPEG that of the right picture, now and then
    std::vector<std::byte> disparity;  ///< lossless; empty where the frame has no disparity. Of a
                                       ///< raw pair: the right picture

    std::size_t bytes() const { return header.size() + colour.size() + disparity.size(); }
};

/// Packs a view's colour ahead of the rest, on another thread than its FrameEncoder's. Not
/// thread-safe.
class ColourPacker {
  public:
    /// As the FrameEncoder's that packs the rest.
    explicit ColourPacker(int jpeg_quality, Chroma chroma = Chroma::quarter);
    ~ColourPacker();

    /// Sets frame.packed_colour and frame.times.pack_ms. Precondition: the frame has colour.
    void pack(RigFrame& frame);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// RigFrame to parts. Keeps its codecs between frames. Not thread-safe.
class FrameEncoder {
  public:
    /// jpeg_quality 1..100, or 0 for lossless colour. Raw pairs are always lossless.
    explicit FrameEncoder(int jpeg_quality, Chroma chroma = Chroma::quarter);
    ~FrameEncoder();

    /// Takes over packed_colour, where there is one. Fills in frame.times.pack_ms and
    /// frame.published. Throws Error naming the first value that may not travel: what it packs,
    /// every decoder takes.
    PackedFrame encode(RigFrame& frame);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// What a frame's header says, before its pictures are decoded.
struct FrameHead {
    enum class Colour { none, jpeg, lossless };
    RigFrame frame;  ///< all but its pictures; geometry has the colour's size
    Colour colour = Colour::none;
    std::size_t right_jpeg_bytes = 0;  ///< at the end of the colour payload
    cv::Size disparity_px;             ///< 0x0: the frame has none
};
/// Throws Error as FrameDecoder::decode.
FrameHead decode_frame_head(std::span<const std::byte> header);

/// The pictures in a colour payload.
struct ColourParts {
    std::span<const std::byte> left, right;  ///< right: a JPEG; empty: there is none
};
/// Throws Error where the payload is too short for what the head says.
ColourParts colour_parts(const FrameHead& head, std::span<const std::byte> colour);

/// A copy; null if there are none.
SharedBytes shared(std::span<const std::byte> bytes);

/// Parts to RigFrame. Keeps its codecs between frames. Not thread-safe.
class FrameDecoder {
  public:
    FrameDecoder();
    ~FrameDecoder();

    /// Takes nothing on trust: throws Error with one sentence for what is truncated, oversized, of
    /// another schema version, of sizes that contradict each other, not finite or no rigid pose,
    /// all before memory is taken for the pictures.
    RigFrame decode(std::span<const std::byte> header, std::span<const std::byte> colour,
                    std::span<const std::byte> disparity);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
