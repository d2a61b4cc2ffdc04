#pragma once

#include <string>
#include <vector>

#include "common/receive/rig_status.h"

namespace vantage {

/// Whether it gives pictures to the stage of these rigs, as far as its own numbers say.
bool delivers(const RigStatus& rig, const std::vector<RigStatus>& rigs);

/// Whether it films as soon as a host runs the stage: its trigger waits for the first pulse.
bool waits_for_a_host(const RigStatus& rig);

/// Of a rig that is connected and sends nothing though nothing else is wrong with it: that it is
/// so, and what to look at. Empty for any other.
std::string silence_of(const RigStatus& rig);

}  // namespace vantage
