#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "common/receive/rig_status.h"

namespace vantage {

// A rig in a few words, for a desk. `vantage rigs status` says more.

/// How its clock stands to the stage's: "PTP -120 ns", "this computer", "no PTP"; empty for one
/// that is away.
std::string short_clock_words(const RigStatus& rig);

/// Whole days since a date such as 2026-11-23 or 2026-11-23T07:30:00Z; nothing: it is none.
std::optional<int> days_since(const std::string& date, std::chrono::system_clock::time_point now);

/// Age and residual of its calibration, "12 d, 0.21 px"; empty: it has none from a file.
std::string calibration_words(const RigHealth& health, std::chrono::system_clock::time_point now);

}  // namespace vantage
