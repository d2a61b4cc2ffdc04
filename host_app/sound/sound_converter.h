#pragma once

#include <span>
#include <vector>

#include "common/av/av_handles.h"
#include "common/av/sound.h"

namespace vantage {

/// Makes sound of it, whatever rate and sample format it comes in.
class SoundConverter {
  public:
    /// Of one channel both are made, of more than two what a listener of two should hear. Throws
    /// Error if FFmpeg cannot.
    SoundConverter(AVChannelLayout channels, AVSampleFormat format, int rate_hz);

    /// Planes as FFmpeg has them, `count` samples. What the filter holds back comes with the next
    /// ones. Throws Error if memory is short.
    std::vector<float> convert(const std::uint8_t* const* planes, int count);
    /// What is held back.
    std::vector<float> rest() { return convert(nullptr, 0); }

  private:
    SwrContextPtr context_;
};

}  // namespace vantage
