#include "common/av/sound.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Catmull-Rom interpolation between the middle two of four samples.
float between(float before, float a, float b, float after, float share) {
    const float slope_a = 0.5F * (b - before), slope_b = 0.5F * (after - a);
    const float c = 3 * (b - a) - 2 * slope_a - slope_b, d = 2 * (a - b) + slope_a + slope_b;
    return a + share * (slope_a + share * (c + share * d));
}

}  // namespace

std::int64_t sound_sample_at(TaiTime time) {
    const std::int64_t ns = to_ns(time);
    const std::int64_t seconds = ns / nanoseconds_per_second, rest = ns % nanoseconds_per_second;
    return seconds * sound_rate_hz +
           (rest * sound_rate_hz + nanoseconds_per_second / 2) / nanoseconds_per_second;
}

TaiTime time_of_sound(std::int64_t sample) {
    return tai_from_ns(sample / sound_rate_hz * nanoseconds_per_second +
                       sample % sound_rate_hz * nanoseconds_per_second / sound_rate_hz);
}

std::int64_t SoundGrid::first_of(std::int64_t tick) const {
    // Dividing first keeps the products within 64 bits, so that the result is exact for years.
    const std::int64_t whole = tick / rate_.pulses, rest = tick % rate_.pulses;
    return whole * rate_.seconds * sound_rate_hz +
           rest * rate_.seconds * sound_rate_hz / rate_.pulses;
}

std::vector<float> stretched(std::span<const float> samples, std::size_t count) {
    const std::size_t given = samples.size() / sound_channels;
    std::vector<float> result(count * sound_channels);
    if (given == count) {
        std::copy(samples.begin(), samples.end(), result.begin());
        return result;
    }
    if (given == 0) return result;
    const double step = static_cast<double>(given) / static_cast<double>(count);
    const auto last = static_cast<std::ptrdiff_t>(given) - 1;
    for (std::size_t i = 0; i < count; ++i) {
        const double at = static_cast<double>(i) * step;
        const auto here = static_cast<std::ptrdiff_t>(at);
        const auto share = static_cast<float>(at - static_cast<double>(here));
        for (std::size_t channel = 0; channel < sound_channels; ++channel) {
            const auto sample = [&](std::ptrdiff_t n) {
                const auto clamped =
                    static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(n, 0, last));
                return samples[clamped * sound_channels + channel];
            };
            result[i * sound_channels + channel] =
                between(sample(here - 1), sample(here), sample(here + 1), sample(here + 2), share);
        }
    }
    return result;
}

}  // namespace vantage
