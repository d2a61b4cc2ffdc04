#pragma once

#include <string>

#include "common/base/time.h"

namespace vantage {

/// SMPTE 12M time-of-day code "hh:mm:ss:ff" of an instant on CLOCK_TAI, frames counted within the
/// second at the rate (non-drop); above 60 Hz, which the code has no numbers for, two or more
/// frames share one. Every rig of a stage gives the same instant the same code.
std::string time_of_day_code(TaiTime instant, double rate_hz);

}  // namespace vantage
