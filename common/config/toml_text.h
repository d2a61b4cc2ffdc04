#pragma once

#include <string>

namespace vantage {

/// Formats a TOML string. Precondition: no control characters.
std::string toml_string(const std::string& text);

/// Why a text is not valid as a name given by a person: "is longer than 40 bytes"; empty if valid.
std::string fault_of_name(const std::string& name);

}  // namespace vantage
