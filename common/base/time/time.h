#pragma once

#include <chrono>
#include <cstdint>

namespace vantage {

inline constexpr std::int64_t nanoseconds_per_second = 1'000'000'000;

/// A point in time is an int64 count of nanoseconds that carries its clock in its type, so that
/// readings of different clocks cannot be compared or subtracted by mistake.
template <class Clock>
using TimePoint = std::chrono::time_point<Clock, std::chrono::nanoseconds>;

/// CLOCK_TAI: the stage's common clock, disciplined by PTP. Epoch 1970-01-01T00:00:00 TAI (as SMPTE
/// ST 2059).
struct TaiClock {
    using duration = std::chrono::nanoseconds;
    using rep = duration::rep;
    using period = duration::period;
    using time_point = TimePoint<TaiClock>;
    static constexpr bool is_steady = false;
    static time_point now();
};

/// CLOCK_MONOTONIC of this computer: for durations, and the domain of V4L2 and libcamera sensor
/// timestamps.
struct MonotonicClock {
    using duration = std::chrono::nanoseconds;
    using rep = duration::rep;
    using period = duration::period;
    using time_point = TimePoint<MonotonicClock>;
    static constexpr bool is_steady = true;
    static time_point now();
};

using TaiTime = TimePoint<TaiClock>;
using MonotonicTime = TimePoint<MonotonicClock>;

template <class Clock>
std::int64_t to_ns(TimePoint<Clock> t) {
    return t.time_since_epoch().count();
}
/// To the nearest nanosecond.
inline std::chrono::nanoseconds from_s(double s) {
    return std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(s));
}
/// To the nearest nanosecond.
inline std::chrono::nanoseconds from_us(double us) {
    return std::chrono::round<std::chrono::nanoseconds>(
        std::chrono::duration<double, std::micro>(us));
}
inline double to_us(std::chrono::nanoseconds time) {
    return std::chrono::duration<double, std::micro>(time).count();
}
inline double to_ms(std::chrono::nanoseconds time) {
    return std::chrono::duration<double, std::milli>(time).count();
}

inline double ms_since(MonotonicTime start) { return to_ms(MonotonicClock::now() - start); }

inline TaiTime tai_from_ns(std::int64_t ns) { return TaiTime(std::chrono::nanoseconds(ns)); }
inline MonotonicTime monotonic_from_ns(std::int64_t ns) {
    return MonotonicTime(std::chrono::nanoseconds(ns));
}

/// Sleeps until the absolute time on CLOCK_TAI; returns at once if it has passed. It returns early
/// if CLOCK_TAI is set back: it never sleeps longer than was left at the call.
void sleep_until(TaiTime deadline);

}  // namespace vantage
