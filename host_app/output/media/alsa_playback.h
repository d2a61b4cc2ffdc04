#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct _snd_pcm;

namespace vantage {

/// Plays one channel of sound at 48 kHz on all channels of an ALSA device. The device has its own
/// clock: drift is corrected by stretching the sound by at most 0.5 percent.
class AlsaPlayback {
  public:
    /// Throws Error if the device cannot be opened or needs another rate.
    explicit AlsaPlayback(const std::string& name);
    ~AlsaPlayback();
    AlsaPlayback(const AlsaPlayback&) = delete;
    AlsaPlayback& operator=(const AlsaPlayback&) = delete;

    /// Returns false if the device's buffer is full. Throws Error if the device is gone.
    bool play(std::span<const float> samples);
    /// Number of times that the buffer ran empty.
    std::uint64_t underruns() const { return underruns_; }

  private:
    struct Inpainting {
        void operator()(_snd_pcm* device) const;
    };
    void fill_up();
    [[noreturn]] void refuse(const char* what, int code) const;

    std::string name_;
    std::unique_ptr<_snd_pcm, Inpainting> device_;
    unsigned channels_ = 2;
    std::vector<std::int16_t> raw_;
    std::uint64_t underruns_ = 0;
};

}  // namespace vantage
