#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "host_app/sound/sound_decoder.h"

struct _snd_pcm;

namespace vantage {

/// Redirects the messages of ALSA from stderr to our log at level `debug`, in the whole process.
void keep_alsa_log();

/// Captures from an ALSA device, including PulseAudio's and PipeWire's. Not thread-safe.
class AlsaCapture {
  public:
    /// `left`, `right`: channels, counted from 1; 0: the first two, or the only one for both.
    /// Throws Error if the device cannot be opened or lacks a channel.
    AlsaCapture(const std::string& name, unsigned left, unsigned right);
    ~AlsaCapture();
    AlsaCapture(const AlsaCapture&) = delete;
    AlsaCapture& operator=(const AlsaCapture&) = delete;

    struct Piece {
        std::vector<float> samples;  ///< empty: none came
        TaiTime heard_until{};       ///< time of the last sample
    };
    /// Reads what has come, waiting up to `most`. Throws Error if the device is gone.
    Piece read(std::chrono::milliseconds most);

  private:
    struct Close {
        void operator()(_snd_pcm* device) const;
    };
    void choose_format();
    void recover(int code);
    [[noreturn]] void refuse(const char* what, int code) const;

    std::string name_;
    std::unique_ptr<_snd_pcm, Close> device_;
    int format_ = 0;
    unsigned rate_hz_ = 0, channels_ = 0;
    std::size_t left_ = 0, right_ = 0;
    std::vector<std::uint8_t> raw_;
    std::optional<SoundConverter> converter_;  ///< if the device has another rate
};

}  // namespace vantage
