#pragma once

#include <cstdint>
#include <string>

#include "host_app/frames/past_frame_sets.h"

namespace vantage {

/// Parses a time in the past that an operator typed, and returns its pulse. Accepted are the time
/// code of the stage, "20:15:07:12", which without frames means the first frame of that second and
/// may end with Z or an offset from UTC ("+01:00"); seconds from the start, "12.5"; and seconds
/// before the end, "-3". The separator before the frames of a drop-frame time code may be any. In
/// the hour that occurs twice the later time is taken. `tai_offset_s` is that of TimecodeClock.
/// Throws Error if the text is none of these or the time is outside the past.
std::uint64_t pulse_in_past(const std::string& words, const PastFrameSets::Span& past,
                            double pulse_rate_hz, int tai_offset_s);

}  // namespace vantage
