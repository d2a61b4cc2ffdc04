#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/receive/rig_status.h"

namespace vantage {

// Short texts about a rig's state for the desk and for `vantage rigs status`.

/// Formats the state of a rig's clock: "PTP -120 ns", "this computer" or "no PTP"; empty if the rig
/// is disconnected.
std::string short_clock_words(const RigStatus& rig);

/// Returns the whole days since a date such as 2026-11-23 or 2026-11-23T07:30:00Z, and 0 for a date
/// in the future; nothing if it is not a date.
std::optional<int> days_since(const std::string& date, std::chrono::system_clock::time_point now);

/// Formats age and residual of a calibration, such as "12 d, 0.21 px"; empty if there is none.
std::string calibration_words(const RigHealth& health, std::chrono::system_clock::time_point now);

/// Whether a rig sends frames that the stage of these rigs can use.
bool delivers(const RigStatus& rig, const std::vector<RigStatus>& rigs);

/// Whether a rig is armed and starts with the first pulse of a host.
bool waits_for_a_host(const RigStatus& rig);

/// Explains why a connected rig without any other trouble sends nothing, and what to check; empty
/// for any other rig.
std::string silence_of(const RigStatus& rig);

}  // namespace vantage
