#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "common/base/percentiles.h"
#include "common/wire/link_message.h"

namespace vantage {

// A rig's state as JSON and as text for people, the same on rig and host.

nlohmann::ordered_json to_json(const Percentiles& percentiles);
nlohmann::ordered_json to_json(const RigCounters& counters);
nlohmann::ordered_json to_json(const RigSync& sync);
/// `temperature_c` is null without a sensor, `calibration` is null without a calibration file.
nlohmann::ordered_json to_json(const RigHealth& health);

/// Pulses and their lateness; empty for a rig without a trigger.
std::string pulse_text(const RigSync& sync);
/// Rates, temperature, supply and calibration.
std::string health_text(const RigHealth& health);

}  // namespace vantage
