#pragma once

#include <filesystem>
#include <span>

#include "common/av/av_handles.h"
#include "common/av/sound.h"

namespace vantage {

/// Writer of a WAV file with one channel of 16 bits at 48 kHz. The file gets its final name once it
/// is complete.
class WavFile {
  public:
    /// Throws Error if it cannot be written.
    explicit WavFile(std::filesystem::path path);
    ~WavFile();
    WavFile(const WavFile&) = delete;
    WavFile& operator=(const WavFile&) = delete;

    /// Throws Error if the disk fails.
    void add(std::span<const float> samples);
    void finish();
    std::uint64_t bytes() const;

  private:
    [[noreturn]] void fail_writing(int code) const;

    std::filesystem::path path_, partial_;
    AvOutputPtr output_;
    AvPacketPtr packet_;
    std::int64_t samples_ = 0;
    bool is_finished_ = false;
};

}  // namespace vantage
