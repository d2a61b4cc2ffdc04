#pragma once

#include <cstdint>
#include <ctime>
#include <optional>
#include <string>

#include "common/base/time/pulse_grid.h"

namespace vantage {

/// A point in local time of this process's time zone.
struct ClockTime {
    std::string text;  ///< as given
    std::time_t utc_s = 0;
    std::optional<int> frame;  ///< if given as time code
};
struct ClockSpan {
    ClockTime from, to;
};
/// Parses "20:15:00", "20:15:00:12" or "20:15:00;12" (time code), each optionally with a date,
/// "2026-11-22T20:15:00", and with Z or an offset from UTC, "+01:00". Without a date, `from` is the
/// last such time before `now`, and `to` the first after `from`. In the hour that occurs twice,
/// `from` without an offset is the later time that has passed, and the log says so. Throws Error
/// for an invalid time, or if `to` is not after `from`.
ClockSpan clock_span(const std::string& from, const std::string& to, std::time_t now);

/// The first pulse at or after the time, or with that time code. `tai_offset_s`: see TimecodeClock.
/// Throws Error if the time code does not exist at this rate.
std::uint64_t pulse_of(const ClockTime& time, const PulseGrid& pulses, int tai_offset_s);

}  // namespace vantage
