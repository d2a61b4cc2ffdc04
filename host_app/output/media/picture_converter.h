#pragma once

#include "common/av/av_handles.h"
#include "common/image/image.h"

namespace vantage {

/// Makes a programme's picture (RGBA) one of another pixel format: YUV by ITU-R BT.709 in studio
/// range, as television has it.
class PictureConverter {
  public:
    /// Throws Error if there is no way to that format.
    PictureConverter(int width_px, int height_px, AVPixelFormat format);

    /// At least of the converter's size; what is beyond is left out. The frame is good until the
    /// next call.
    AVFrame& convert(const ColourImage& picture);

  private:
    SwsContextPtr context_;
    AvFramePtr frame_;
};

}  // namespace vantage
