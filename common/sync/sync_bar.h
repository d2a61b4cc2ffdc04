#pragma once

#include <chrono>
#include <cstdint>

#include "common/base/time/time.h"

namespace vantage {

/// A row of LEDs that counts steps in reflected Gray code (F. Gray, US 2632058, 1953), so that only
/// one LED changes at each step. LED k shows bit k and is lit half of the time, in longer periods
/// for larger k. Step 0 begins at 1970-01-01T00:00:00 TAI and at every whole period after it.
class SyncBar {
  public:
    /// Throws Error unless `leds` is within least_leds to most_leds and the step within 10 us to 1
    /// s.
    SyncBar(int leds, std::chrono::nanoseconds step);

    static constexpr int least_leds = 5, most_leds = 20;

    int leds() const { return leds_; }
    std::chrono::nanoseconds step() const { return step_; }
    /// The time after which the pattern repeats.
    std::chrono::nanoseconds period() const { return step_ * (std::int64_t{1} << leds_); }
    /// The time between two changes of an LED.
    std::chrono::nanoseconds half_wave(int led) const;

    /// The step at a time, from 0 to 2^leds - 1, and the LEDs lit in it (bit k: LED k).
    std::uint32_t step_at(TaiTime time) const;
    static std::uint32_t lit_in(std::uint32_t step) { return step ^ (step >> 1); }
    /// The step in which exactly these LEDs are lit.
    static std::uint32_t step_of(std::uint32_t lit);

    /// The time since the start of the bar's current period.
    std::chrono::nanoseconds phase_at(TaiTime time) const;
    /// The share of an exposure during which an LED is lit, 0 to 1: its brightness between dark and
    /// full in a sensor with a linear response. `begin_ns` is relative to the bar's period, and may
    /// be outside it. Precondition: length_ns > 0.
    double lit_share(int led, double begin_ns, double length_ns) const;

  private:
    double lit_before_ns(int led, double time_ns) const;

    int leds_;
    std::chrono::nanoseconds step_;
};

}  // namespace vantage
