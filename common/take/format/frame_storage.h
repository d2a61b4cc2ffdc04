#pragma once

#include <optional>

#include "common/take/format/lossless_pictures.h"
#include "common/take/take_writer.h"
#include "common/wire/codec/colour_codec.h"
#include "common/wire/codec/disparity_codec.h"
#include "common/wire/frame_codec.h"

namespace vantage {

/// The tracks for frames like this one. Throws Error for a raw pair: a take holds views only.
TakeRig take_rig_of(const FrameHead& head);

/// Converts the frames of one rig to the form of its tracks: a JPEG stays as it came; disparity and
/// lossless colour become FFV1. Not thread-safe.
class FrameStorer {
  public:
    explicit FrameStorer(const TakeRig& rig);

    /// Throws Error if the frame is damaged, or has another size or codec than the tracks.
    StoredFrame store(const PackedFrame& frame);

  private:
    TakeRig rig_;
    std::optional<LosslessPictureEncoder> colour_, depth_;
    LosslessColourDecoder lossless_colour_;
    DisparityDecoder disparity_;
};

/// Memory to decode a frame into: images of the size of the tracks. Where one is empty, the decoder
/// allocates it.
struct FrameMemory {
    ColourImage colour;
    DisparityImage disparity;
};

/// Decodes stored frames to what the host would have decoded, bit for bit. Not thread-safe.
class FrameRestorer {
  public:
    explicit FrameRestorer(const TakeRig& rig);

    /// Throws Error if the frame is damaged.
    RigFrame restore(const StoredFrame& frame, FrameMemory memory = {});

  private:
    TakeRig rig_;
    JpegDecoder jpeg_;
    std::optional<LosslessPictureDecoder> colour_, depth_;
};

}  // namespace vantage
