#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "host_app/control/table/control_command.h"

namespace vantage {

/// The commands and the lamps of a document, docs/control.md or docs/replay_commands.md, as it has
/// them.
std::string command_table(ControlPage page);
std::string lamp_table(ControlPage page);
nlohmann::ordered_json control_json();

}  // namespace vantage
