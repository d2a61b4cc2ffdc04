#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"

namespace vantage {

// All sound is interleaved stereo: floats of -1 to 1, left and right in turn, 48000 sample frames
// per second. A "sample" is one pair. Live samples are numbered from 1970-01-01T00:00:00 TAI, like
// trigger pulses.

inline constexpr int sound_rate_hz = 48000;
inline constexpr std::size_t sound_channels = 2;

/// The sample nearest to a time.
std::int64_t sound_sample_at(TaiTime time);
/// The time of a sample, rounded down to a nanosecond.
TaiTime time_of_sound(std::int64_t sample);

/// A block of contiguous samples.
struct SoundBlock {
    std::int64_t first = 0;      ///< number of the first sample
    std::vector<float> samples;  ///< `sound_channels` values per sample

    std::int64_t count() const {
        return static_cast<std::int64_t>(samples.size() / sound_channels);
    }
    std::int64_t end() const { return first + count(); }
};

/// Divides samples over the programme's ticks: 960 per tick at 50 Hz; 1601 and 1602 in turn at
/// 29.97 Hz.
class SoundGrid {
  public:
    explicit SoundGrid(double rate_hz) : rate_(PulseGrid(rate_hz).rate()) {}
    /// The first sample of a tick; 0 for tick 0.
    std::int64_t first_of(std::int64_t tick) const;

  private:
    PulseGrid::Fraction rate_;
};

/// Resamples to `count` samples, which shifts the pitch. For sound that slips a little in time
/// without a break. The same count returns the same bits.
std::vector<float> stretched(std::span<const float> samples, std::size_t count);

}  // namespace vantage
