#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "host_app/sound/sound_converter.h"

namespace vantage {

/// Decodes the sound of a file, whatever FFmpeg reads, from its beginning on.
class SoundDecoder {
  public:
    /// Throws Error if it cannot be read, or has no sound.
    explicit SoundDecoder(std::filesystem::path path);

    /// The next samples; fewer than `count` at the end. Throws
    /// Error if the file cannot be read on.
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
    std::vector<float> decoded_;  ///< that nobody took yet
    bool is_at_end_ = false;
};

}  // namespace vantage
