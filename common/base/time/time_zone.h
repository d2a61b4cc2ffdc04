#pragma once

#include <string>

namespace vantage {

/// Whether this computer knows a time zone of that name ("Europe/Stockholm", "UTC").
bool is_time_zone(const std::string& name);

/// Sets the time zone of this process; the default is the computer's. Call it before other threads
/// start. Throws Error for an unknown zone.
void use_time_zone(const std::string& name);

}  // namespace vantage
