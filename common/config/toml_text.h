#pragma once

#include <string>

namespace vantage {

/// A TOML string. Precondition: no control characters.
std::string toml_string(const std::string& text);

/// What keeps this from being a name that a person gave something: "is longer than 40 bytes".
/// Empty: nothing does.
std::string fault_of_name(const std::string& name);

}  // namespace vantage
