#pragma once

#include <chrono>
#include <cstdint>

#include "common/base/time/time.h"

namespace vantage {

/// The trigger pulses of the stage's clock: pulse k is at k / rate after 1970-01-01T00:00:00 TAI,
/// the alignment of SMPTE ST 2059. The rate is a fraction, so that pulses stay on the grid for
/// decades: 23.976, 29.97, 59.94 etc. are the broadcast rates n * 1000 / 1001; other rates are
/// rounded to a thousandth of a hertz.
class PulseGrid {
  public:
    /// Precondition: 0.001 <= rate_hz <= 1e6.
    explicit PulseGrid(double rate_hz);

    /// The time of a pulse, rounded down to a nanosecond.
    TaiTime time_of(std::uint64_t index) const;
    /// The last pulse at or before `time`; precondition: `time` is not before 1970.
    std::uint64_t index_at_or_before(TaiTime time) const;
    /// The pulse nearest to `time`.
    std::uint64_t nearest_index(TaiTime time) const;
    /// The time between two pulses, rounded down. For tolerances only; sums of it drift.
    std::chrono::nanoseconds period() const;
    double rate_hz() const;
    /// The rate as a fraction in its lowest terms: 30000/1001 for 29.97.
    struct Fraction {
        std::int64_t pulses, seconds;
    };
    Fraction rate() const;

  private:
    std::int64_t pulses_, seconds_;  ///< the rate: pulses_ per seconds_
};

}  // namespace vantage
