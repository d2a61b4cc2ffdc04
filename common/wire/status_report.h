#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "common/base/percentiles.h"
#include "common/wire/link_message.h"

namespace vantage {

// A rig's state as rig and host show it, for machines and for people.

nlohmann::ordered_json to_json(const Percentiles& percentiles);
nlohmann::ordered_json to_json(const RigCounters& counters);
nlohmann::ordered_json to_json(const RigSync& sync);
/// `temperature_c` is null where the computer has no sensor, `calibration` is null where it has
/// none.
nlohmann::ordered_json to_json(const RigHealth& health);

/// Pulses and their lateness in words; empty for a rig without trigger.
std::string pulse_text(const RigSync& sync);
/// Rates, temperature, supply and calibration in words.
std::string health_text(const RigHealth& health);

}  // namespace vantage
