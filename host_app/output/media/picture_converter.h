#pragma once

#include "common/av/av_handles.h"
#include "common/image/image.h"

namespace vantage {

/// Converts RGBA images to another pixel format; YUV is ITU-R BT.709 in studio range. Not
/// thread-safe.
class PictureConverter {
  public:
    /// Throws Error if FFmpeg cannot convert to that format.
    PictureConverter(int width_px, int height_px, AVPixelFormat format);

    /// The image has at least the converter's size; the rest is cropped. The frame is valid until
    /// the next call.
    AVFrame& convert(const ColourImage& picture);

  private:
    SwsContextPtr context_;
    AvFramePtr frame_;
};

}  // namespace vantage
