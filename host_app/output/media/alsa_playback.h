#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct _snd_pcm;

namespace vantage {

/// A device of ALSA that one channel of sound is played to, on all channels that it has, at 48000
/// samples a second. Its clock is its own: where it runs off, what it is given is stretched by half
/// a percent at the most.
class AlsaPlayback {
  public:
    /// Throws Error if it cannot be opened, or plays at another rate.
    explicit AlsaPlayback(const std::string& name);
    ~AlsaPlayback();
    AlsaPlayback(const AlsaPlayback&) = delete;
    AlsaPlayback& operator=(const AlsaPlayback&) = delete;

    /// False: it has no room now. Throws Error if the device is gone.
    bool play(std::span<const float> samples);
    /// Times that it had nothing to play.
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
