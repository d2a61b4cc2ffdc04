#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "host_app/sound/sound_converter.h"

struct _snd_pcm;

namespace vantage {

/// A device of ALSA that sound is recorded from, PulseAudio's and PipeWire's among them.
class AlsaCapture {
  public:
    /// `left`, `right`: of its channels, counted from 1; 0: the first two, or its only one for
    /// both. Throws Error if it cannot be opened, or has no such channel.
    AlsaCapture(const std::string& name, unsigned left, unsigned right);
    ~AlsaCapture();
    AlsaCapture(const AlsaCapture&) = delete;
    AlsaCapture& operator=(const AlsaCapture&) = delete;

    struct Piece {
        std::vector<float> samples;  ///< empty: nothing came
        TaiTime heard_until{};       ///< its last sample
    };
    /// What has come, waiting so long at the most. Throws Error if the device is gone.
    Piece read(std::chrono::milliseconds most);

  private:
    struct Inpainting {
        void operator()(_snd_pcm* device) const;
    };
    void choose_format();
    void recover(int code);
    [[noreturn]] void refuse(const char* what, int code) const;

    std::string name_;
    std::unique_ptr<_snd_pcm, Inpainting> device_;
    int format_ = 0;
    unsigned rate_hz_ = 0, channels_ = 0;
    std::size_t left_ = 0, right_ = 0;
    std::vector<std::uint8_t> raw_;
    std::optional<SoundConverter> converter_;  ///< of another rate
};

}  // namespace vantage
