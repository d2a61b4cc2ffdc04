#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/av/av_handles.h"
#include "common/image/image.h"

namespace vantage {

/// Encodes images of one size and type (DisparityImage or ColourImage) as FFV1: lossless,
/// intra-only, in slices with a CRC that several threads encode. Not thread-safe.
class LosslessPictureEncoder {
  public:
    /// `type`: CV_16UC1 or CV_8UC4. Throws Error if FFmpeg has no FFV1.
    LosslessPictureEncoder(cv::Size size_px, int type);

    /// The codec's header, which a decoder needs first.
    std::vector<std::byte> setup() const;
    std::vector<std::byte> encode(const cv::Mat& picture);

  private:
    AvCodecContextPtr codec_;
    AvFramePtr frame_;
    AvPacketPtr packet_;
    std::int64_t number_ = 0;
};

class LosslessPictureDecoder {
  public:
    LosslessPictureDecoder(cv::Size size_px, int type, std::span<const std::byte> setup);

    /// Throws Error unless the bytes are exactly one complete image. Decodes into `memory`, an
    /// image of the decoder's size and type, unless it is empty.
    cv::Mat decode(std::span<const std::byte> bytes, cv::Mat memory = {});

  private:
    cv::Size size_px_;
    int type_;
    AvCodecContextPtr codec_;
    AvFramePtr frame_;
    AvPacketPtr packet_;
};

}  // namespace vantage
