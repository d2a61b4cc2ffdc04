#pragma once

#include <optional>

#include "common/take/format/lossless_pictures.h"
#include "common/take/take_writer.h"
#include "common/wire/codec/colour_codec.h"
#include "common/wire/codec/disparity_codec.h"
#include "common/wire/frame_codec.h"

namespace vantage {

/// The tracks that frames like this one need. Throws Error for a raw pair: a take holds views.
TakeRig take_rig_of(const FrameHead& head);

/// Brings what one rig sends into the form of its tracks: a JPEG stays as it came, and disparity,
/// and colour that came lossless, become FFV1. Not thread-safe.
class FrameStorer {
  public:
    explicit FrameStorer(const TakeRig& rig);

    /// Throws Error if the frame is damaged, or of another size or coding than the tracks.
    StoredFrame store(const PackedFrame& frame);

  private:
    TakeRig rig_;
    std::optional<LosslessPictureEncoder> colour_, depth_;
    LosslessColourDecoder lossless_colour_;
    DisparityDecoder disparity_;
};

/// The way back: what the host would have decoded, bit for bit. Not thread-safe.
class FrameRestorer {
  public:
    explicit FrameRestorer(const TakeRig& rig);

    /// Throws Error if the frame is damaged.
    RigFrame restore(const StoredFrame& frame);

  private:
    TakeRig rig_;
    JpegDecoder jpeg_;
    std::optional<LosslessPictureDecoder> colour_, depth_;
};

}  // namespace vantage
