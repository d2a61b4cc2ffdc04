#pragma once

#include <filesystem>
#include <optional>
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

    /// Converts `count` samples in FFmpeg's planes. The filter delays some samples to the next
    /// call. Throws Error if memory runs out.
    std::vector<float> convert(const std::uint8_t* const* planes, int count);
    /// The delayed samples at the end.
    std::vector<float> rest() { return convert(nullptr, 0); }

  private:
    SwrContextPtr context_;
};

/// Decodes the sound of any file that FFmpeg supports, from its beginning. Not thread-safe.
class SoundDecoder {
  public:
    /// Throws Error if the file cannot be read, or has no sound.
    explicit SoundDecoder(std::filesystem::path path);

    /// The next samples; fewer than `count` at the end. Throws Error if the file cannot be read.
    std::vector<float> next(std::size_t count);

  private:
    void decode_some();
    void take_frames();
    [[noreturn]] void refuse(int code) const;

    std::filesystem::path path_;
    AvInputPtr input_;
    const AVStream* stream_ = nullptr;
    AvCodecContextPtr decoder_;
    AvPacketPtr packet_;
    AvFramePtr frame_;
    std::optional<SoundConverter> converter_;
    std::vector<float> decoded_;  ///< decoded, but not returned yet
    bool is_at_end_ = false;
};

}  // namespace vantage
