#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "host_app/sound/sound_converter.h"

namespace vantage {

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
