#pragma once

#include <string>

namespace vantage {

/// Whether this computer knows a zone of that name ("Europe/Stockholm", "UTC").
bool is_time_zone(const std::string& name);

/// From now on this process's local time is that of the zone; before, it is the computer's. To be
/// called before there are threads. Throws Error for a zone that is not known.
void use_time_zone(const std::string& name);

}  // namespace vantage
