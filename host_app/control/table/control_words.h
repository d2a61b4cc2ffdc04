#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "host_app/control/table/control_command.h"

namespace vantage {

/// The tables of commands and lamps in docs/operate/control.md and docs/reference/commands.md, as
/// Markdown.
std::string command_table(ControlPage page);
std::string lamp_table(ControlPage page);
/// Both tables for `vantage control --json`.
nlohmann::ordered_json control_json();

}  // namespace vantage
