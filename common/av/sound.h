#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"

namespace vantage {

// Sound is the same everywhere: floats of -1 to 1, left and right in turn, 48000 samples a second.
// A sample is one of each. Those that were heard are counted from 1970-01-01T00:00:00 TAI on, as
// pulses are.

inline constexpr int sound_rate_hz = 48000;
inline constexpr std::size_t sound_channels = 2;

/// The sample that was heard nearest to this time.
std::int64_t sound_sample_at(TaiTime time);
/// Rounded down to a nanosecond.
TaiTime time_of_sound(std::int64_t sample);

/// Sound without a gap.
struct SoundBlock {
    std::int64_t first = 0;      ///< sample
    std::vector<float> samples;  ///< `sound_channels` each

    std::int64_t count() const {
        return static_cast<std::int64_t>(samples.size() / sound_channels);
    }
    std::int64_t end() const { return first + count(); }
};

/// Which samples a tick of the programme has: 960 at 50 Hz; at 29.97 Hz 1601 and 1602 in turn.
class SoundGrid {
  public:
    explicit SoundGrid(double rate_hz) : rate_(PulseGrid(rate_hz).rate()) {}
    /// Of the tick; 0 of tick 0.
    std::int64_t first_of(std::int64_t tick) const;

  private:
    PulseGrid::Fraction rate_;
};

/// The same sound, `count` samples long and so much higher or lower: what slides a little in time
/// without a break. The same number gives the same bits.
std::vector<float> stretched(std::span<const float> samples, std::size_t count);

}  // namespace vantage
