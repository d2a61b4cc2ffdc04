#pragma once

#include <optional>
#include <string>

namespace vantage {

/// Takes "Z", "+01:00", "-0330" or "+01" off the end of a time of day, as ISO 8601 writes how far
/// the time is ahead of UTC. Seconds ahead; nothing: there is none, and `text` stays as it is.
std::optional<int> take_utc_offset(std::string& text);

}  // namespace vantage
