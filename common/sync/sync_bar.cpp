#include "common/sync/sync_bar.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"

namespace vantage {

SyncBar::SyncBar(int leds, std::chrono::nanoseconds step) : leds_(leds), step_(step) {
    using std::chrono::microseconds;
    if (leds < least_leds || leds > most_leds)
        fail("a bar has {} to {} LEDs, not {}", least_leds, most_leds, leds);
    if (step < microseconds(10) || step > std::chrono::seconds(1))
        fail("a bar's step is 10 to 1000000 us, not {}",
             std::chrono::duration_cast<microseconds>(step).count());
}

std::chrono::nanoseconds SyncBar::half_wave(int led) const {
    // The code is cyclic: the slowest LED changes as rarely as the one before it.
    return step_ * (std::int64_t{1} << std::min(led + 1, leds_ - 1));
}

std::uint32_t SyncBar::step_at(TaiTime time) const {
    return static_cast<std::uint32_t>(phase_at(time) / step_);
}

std::uint32_t SyncBar::step_of(std::uint32_t lit) {
    std::uint32_t step = lit;
    for (unsigned shift = 1; shift < 32; shift *= 2) step ^= step >> shift;
    return step;
}

std::chrono::nanoseconds SyncBar::phase_at(TaiTime time) const {
    const std::chrono::nanoseconds phase = time.time_since_epoch() % period();
    return phase.count() < 0 ? phase + period() : phase;
}

double SyncBar::lit_before_ns(int led, double time_ns) const {
    const auto half = static_cast<double>(half_wave(led).count());
    const double dark = static_cast<double>(step_.count()) * static_cast<double>(1 << led);
    const double waves = std::floor(time_ns / (2 * half));
    return waves * half + std::clamp(time_ns - waves * 2 * half - dark, 0.0, half);
}

double SyncBar::lit_share(int led, double begin_ns, double length_ns) const {
    return (lit_before_ns(led, begin_ns + length_ns) - lit_before_ns(led, begin_ns)) / length_ns;
}

}  // namespace vantage
