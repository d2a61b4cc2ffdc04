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
    /// Converts the sample format only: the channels and the rate stay.
    static SoundConverter of_format(AVChannelLayout channels, AVSampleFormat format, int rate_hz);

    /// Converts `count` samples in FFmpeg's planes. The filter delays some samples to the next
    /// call. Throws Error if memory runs out.
    std::vector<float> convert(const std::uint8_t* const* planes, int count);
    /// The delayed samples at the end.
    std::vector<float> rest() { return convert(nullptr, 0); }

  private:
    SoundConverter(AVChannelLayout from, AVSampleFormat format, int from_hz, AVChannelLayout to,
                   int to_hz);

    SwrContextPtr context_;
    std::size_t channels_;  ///< of the result
};

/// Decodes the sound of any file that FFmpeg supports, from its beginning. Not thread-safe.
class SoundDecoder {
  public:
    /// Throws Error if the file cannot be read, or has no sound.
    explicit SoundDecoder(std::filesystem::path path);
    /// Decodes the file's own channels at its own rate instead of the internal form.
    static SoundDecoder as_stored(std::filesystem::path path);

    /// The next samples; fewer than `count` at the end. Throws Error if the file cannot be read.
    std::vector<float> next(std::size_t count);

    /// Of the samples that next() returns.
    int rate_hz() const { return is_as_stored_ ? decoder_->sample_rate : sound_rate_hz; }
    std::size_t channels() const {
        return is_as_stored_ ? static_cast<std::size_t>(decoder_->ch_layout.nb_channels)
                             : sound_channels;
    }

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
    bool is_as_stored_ = false;
};

}  // namespace vantage
