#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/av/av_handles.h"
#include "common/image/image.h"

namespace vantage {

/// Pictures of one size and kind (DisparityImage or ColourImage) as FFV1: lossless, every picture
/// by itself, in slices that carry a CRC and are coded by several threads. Not thread-safe.
class LosslessPictureEncoder {
  public:
    /// `type`: CV_16UC1 or CV_8UC4. Throws Error if FFmpeg comes without FFV1.
    LosslessPictureEncoder(cv::Size size_px, int type);

    /// What a decoder needs to know beforehand.
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

    /// Throws Error unless the bytes are exactly one whole picture.
    cv::Mat decode(std::span<const std::byte> bytes);

  private:
    cv::Size size_px_;
    int type_;
    AvCodecContextPtr codec_;
    AvFramePtr frame_;
    AvPacketPtr packet_;
};

}  // namespace vantage
