#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace vantage {

/// The table of commands, and that of lamps, as docs/control.md has them.
std::string command_table();
std::string lamp_table();
nlohmann::ordered_json control_json();

}  // namespace vantage
