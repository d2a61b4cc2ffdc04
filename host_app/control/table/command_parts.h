#pragma once

#include "host_app/control/table/control_command.h"

namespace vantage {

// The parts of the table of commands.
std::span<const ControlCommand> replay_commands();
std::span<const ControlCommand> show_commands();

}  // namespace vantage
