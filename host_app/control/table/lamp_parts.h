#pragma once

#include "host_app/control/table/lamp.h"

namespace vantage {

// The parts of the table of lamps.
std::span<const Lamp> replay_lamps();
std::span<const Lamp> show_lamps();

}  // namespace vantage
