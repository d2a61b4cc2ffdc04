#pragma once

#include <chrono>
#include <string>

#include "common/config/endpoint.h"

namespace vantage {

/// Tries to open a connection to the endpoint, and closes it again. Empty if that works; else in a
/// sentence why not: the name does not resolve, the connection is refused, nothing answers within
/// `limit`. Looking a name up may take longer than the limit.
std::string why_unreachable(const Endpoint& endpoint, std::chrono::milliseconds limit);

}  // namespace vantage
