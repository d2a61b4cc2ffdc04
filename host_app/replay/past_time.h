#pragma once

#include <cstdint>
#include <string>

#include "host_app/frames/past_frame_sets.h"

namespace vantage {

/// The pulse that a person names by its time in what there is of the past: "20:15:07:12", the
/// house's time code (without frames the first of the second; drop-frame code with any mark),
/// each also with Z or an offset from UTC ("+01:00") behind it; without, the later one in the hour
/// that comes twice), "12.5", seconds after its beginning, "-3", before its end. `tai_offset_s`: as
/// TimecodeClock's. Throws Error if the words are none of these, or the time is not in it.
std::uint64_t pulse_in_past(const std::string& words, const PastFrameSets::Span& past,
                            double pulse_rate_hz, int tai_offset_s);

}  // namespace vantage
