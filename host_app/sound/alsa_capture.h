#pragma once

#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/av/sound.h"
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

/// Assigns times to the blocks of a device. A device has a clock of its own: blocks are shortened
/// or lengthened by a sample now and then to follow the computer's clock, inaudibly. Not
/// thread-safe.
class SoundPlacer {
  public:
    /// Places the next block, whose last sample was heard at about `heard_until`. Empty: the block
    /// came far too early and is dropped.
    SoundBlock place(std::span<const float> block, TaiTime heard_until);

    struct Stats {
        std::uint64_t heard = 0, lost = 0, dropped = 0, inserted = 0, removed = 0;
        /// How fast the device's clock is relative to this computer's.
        double drift_ppm() const {
            return heard == 0
                       ? 0
                       : 1e6 * (static_cast<double>(removed) - static_cast<double>(inserted)) /
                             static_cast<double>(heard);
        }
    };
    const Stats& stats() const { return stats_; }

  private:
    std::optional<std::int64_t> next_;
    double late_ = 0;  ///< average lateness of blocks in samples, over some seconds
    Stats stats_;
};

}  // namespace vantage
