#pragma once

#include <span>
#include <vector>

#include "common/av/av_handles.h"
#include "common/av/sound.h"

namespace vantage {

/// Converts sound of any rate, channel layout and sample format to the internal form. Not
/// thread-safe.
class SoundConverter {
  public:
    /// A single channel goes to both sides; more than two are mixed down. Throws Error if FFmpeg
    /// cannot convert.
    SoundConverter(AVChannelLayout channels, AVSampleFormat format, int rate_hz);

    /// Converts `count` samples in FFmpeg's planes. The filter delays some samples to the next call.
    /// Throws Error if memory runs out.
    std::vector<float> convert(const std::uint8_t* const* planes, int count);
    /// The delayed samples at the end.
    std::vector<float> rest() { return convert(nullptr, 0); }

  private:
    SwrContextPtr context_;
};

}  // namespace vantage
