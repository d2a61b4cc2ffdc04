#pragma once

#include <chrono>
#include <string>

#include "common/config/endpoint.h"

namespace vantage {

/// Diagnoses an endpoint by opening and closing a connection. Empty if that works, otherwise one
/// sentence: the name does not resolve, the connection is refused, or nothing answers within
/// `limit`. A name lookup may take longer than the limit.
std::string why_unreachable(const Endpoint& endpoint, std::chrono::milliseconds limit);

}  // namespace vantage
