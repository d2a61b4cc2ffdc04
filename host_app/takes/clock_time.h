#pragma once

#include <cstdint>
#include <ctime>
#include <optional>
#include <string>

#include "common/base/time/pulse_grid.h"

namespace vantage {

/// A moment by the clock on the wall of this process's zone.
struct ClockTime {
    std::string text;  ///< as it was given
    std::time_t utc_s = 0;
    std::optional<int> frame;  ///< of a time code
};
struct ClockSpan {
    ClockTime from, to;
};
/// "20:15:00", "20:15:00:12" or "20:15:00;12" (time code), each also behind a date and T:
/// "2026-11-22T20:15:00". Without one `from` is the last such time before `now`, and `to` the first
/// after `from`. Behind each may stand Z or an offset from UTC, "+01:00"; without, in the hour that
/// comes twice `from` is the later one that has passed, and that is logged. Throws Error if the words are none, or `to` is not after `from`.
ClockSpan clock_span(const std::string& from, const std::string& to, std::time_t now);

/// The first pulse that is not before it, or of that time code. `tai_offset_s`: as TimecodeClock.
/// Throws Error if there is no such code at this rate.
std::uint64_t pulse_of(const ClockTime& time, const PulseGrid& pulses, int tai_offset_s);

}  // namespace vantage
