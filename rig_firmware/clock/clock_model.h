#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/time/time.h"

namespace vantage {

/// Carries times of one clock (a sensor's, or CLOCK_MONOTONIC, which the kernel stamps frames with)
/// to CLOCK_TAI: a line fitted to pairs of readings, newest first, so that a clock that runs too
/// fast by some ppm is followed continuously. A pair far off the line is held back: if the next one
/// agrees with it the clock was set, and the fit begins anew there; else it was a bad reading.
class ClockModel {
  public:
    struct State {
        double ppm = 0;           ///< the source clock's excess rate over TAI
        double residual_ns = 0;   ///< of the fit, RMS
        std::uint64_t pairs = 0;  ///< taken since the start
        std::uint64_t outliers = 0;
        std::uint64_t steps = 0;  ///< either clock was set
        double last_step_ns = 0;  ///< by so much, TAI forward of the source
    };

    /// Both clocks read at one moment. Pairs come in the order of their times; one that is no later
    /// than the last (a duplicate) is left out.
    void observe(MonotonicTime source, TaiTime tai);

    /// The clock is known to have been set: begins anew with this pair at once.
    void restart(MonotonicTime source, TaiTime tai);

    /// Whether anything can be carried yet.
    bool ready() const { return !window_.empty(); }
    /// Precondition: ready().
    TaiTime to_tai(MonotonicTime source) const;
    State state() const;

  private:
    struct Pair {
        MonotonicTime source{};
        TaiTime tai{};
    };

    void take(const Pair& pair);
    void fit();

    std::deque<Pair> window_;
    std::optional<Pair> odd_;  ///< the last pair, far off the line
    double slope_ = 0;         ///< TAI nanoseconds a source nanosecond, less 1
    double intercept_ns_ = 0;  ///< of the line at the newest pair, less that pair's
    double residual_ns_ = 0, last_step_ns_ = 0;
    std::uint64_t pairs_ = 0, outliers_ = 0, steps_ = 0;
};

}  // namespace vantage
