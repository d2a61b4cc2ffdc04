#pragma once

#include <optional>
#include <string>

namespace vantage {

/// Removes "Z", "+01:00", "-0330" or "+01" from the end of a time of day, as ISO 8601 writes the
/// offset from UTC. Returns the seconds ahead of UTC; nothing if there is no offset, and `text` is
/// unchanged.
std::optional<int> take_utc_offset(std::string& text);

}  // namespace vantage
